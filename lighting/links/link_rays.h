// The rays that links are made of: from both faces of every surface of one tree, in the tree's own frame, so
// that every instance of the prototype casts the same ones, turned and scaled with it. Ray k of a face starts
// at a point of the face and leaves in a cosine-distributed direction, both from one scrambled
// four-dimensional point set per face: the directions are spread best, then the positions, then both
// together.
#pragma once

#include <memory>

#include "lighting/links/link_lobes.h"
#include "lighting/trace/receivers.h"
#include "lighting/trace/surface_sampler.h"

namespace sunfleck::links {

struct LinkRay {
  Vec3 origin_m, direction;  // unit
  RayStart from;
};

// A prototype standing alone at the origin. Keeps a copy of it while links are traced.
class LoneTree {
 public:
  LoneTree(const Forest& forest, PrototypeId prototype);
  const Forest& forest() const { return forest_; }
  const trace::Receivers& receivers() const { return receivers_; }

 private:
  const Forest forest_;
  const trace::GroundCells no_ground_;
  const trace::Receivers receivers_;
};

// The rays of one lobe of a surface. `surface_key` names the surface among all of the same seed.
class LobeRays {
 public:
  LobeRays(const trace::SurfaceSampler& surface, std::size_t surface_key, Lobe lobe, Part part,
           std::uint64_t seed);
  LinkRay ray(int k) const;

 private:
  const trace::SurfaceSampler& surface_;
  bool front_;
  Part part_;
  std::uint64_t key_, points_;
};

// The lobes of a surface of a tree, and the part of the sphere each looks into.
Lobes lobes_of(const LoneTree& tree, std::size_t surface, int links_per_face);
Part part_of(const LoneTree& tree, std::size_t surface, Lobe lobe);

// The same ray cast by an instance of the tree, in the world.
LinkRay in_world(const LinkRay& ray, const Forest& forest, std::uint32_t instance);

}  // namespace sunfleck::links
