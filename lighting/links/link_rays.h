// The rays that links are made of: from both faces of every surface of one tree, in the tree's own frame, so
// that every instance of the prototype casts the same ones, turned and scaled with it. A ray starts at a
// point of the face and leaves in a cosine-distributed direction, both from one scrambled low-discrepancy set
// per half sphere (leaves) or face: the directions are spread best, then the positions, then both together.
#pragma once

#include <array>
#include <memory>
#include <vector>

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

// The first `links` of the rays are kept, the others only tell sky from the rest.
struct LobeRays {
  std::vector<LinkRay> rays;
  int links = 0;
  double weight = 0;  // of all its rays together in the irradiance of its face
};
using SurfaceRays = std::array<LobeRays, kLobes>;

// Of a surface of a tree: 2 * links_per_face links.
SurfaceRays rays_of_surface(const LoneTree& tree, std::size_t surface, int links_per_face,
                            std::uint64_t seed);
// One lobe of one face with all its rays kept; `key` names the face among all of the same seed.
std::vector<LinkRay> rays_of_face(const trace::SurfaceSampler& surface, bool front, int links,
                                  std::size_t key, std::uint64_t seed);

// The same ray cast by an instance of the tree, in the world.
LinkRay in_world(const LinkRay& ray, const Forest& forest, std::uint32_t instance);

}  // namespace sunfleck::links
