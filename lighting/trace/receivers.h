// Everything that receives and gives back light, numbered: surfaces are the foliage elements in ForestIndex
// order, then every instance's wood (groups of neighbouring segments, and triangles), then the ground cells.
// Foliage and wood have two faces (2 s front or outside, 2 s + 1 back or inside), a ground cell one.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/optics/optics.h"
#include "lighting/trace/ground_cells.h"
#include "lighting/trace/ray_scene.h"
#include "sim/forest/forest.h"

namespace sunfleck::trace {

// Reflectance and transmittance of a surface's two faces, as in LeafOptics.
struct SurfaceOptics {
  float reflect_front = 0, reflect_back = 0, pass_front = 0, pass_back = 0;
};

struct SegmentRange {
  std::uint32_t first = 0, end = 0;
};

// Twigs are many and small: neighbouring segments share one receiver, as far as it stays within about half a
// metre.
struct WoodGroups {
  std::vector<std::uint32_t> first_segment;  // of each group, and the end
  std::vector<std::uint32_t> group_of_segment;
  std::size_t count() const { return first_segment.size() - 1; }
};
WoodGroups group_wood(const Prototype& prototype);

class Receivers {
 public:
  // `ground` with no cells: no ground. Both must outlive the receivers.
  Receivers(const Forest& forest, const GroundCells& ground);

  std::size_t foliage_count() const { return index_.element_count(); }
  std::size_t wood_count() const { return wood_first_.back(); }
  std::size_t two_faced_count() const { return foliage_count() + wood_count(); }
  std::size_t surface_count() const { return two_faced_count() + ground_.count(); }
  std::size_t face_count() const { return 2 * two_faced_count() + ground_.count(); }

  bool is_ground(std::size_t surface) const { return surface >= two_faced_count(); }
  std::size_t first_face(std::size_t surface) const {
    return is_ground(surface) ? two_faced_count() + surface : 2 * surface;
  }
  std::size_t surface_of(std::size_t face) const {
    return face < 2 * two_faced_count() ? face / 2 : face - two_faced_count();
  }
  std::size_t faces_of(std::size_t surface) const { return is_ground(surface) ? 1 : 2; }

  // What a ray that left a face met: a face, or one of the three ends that give no light back.
  std::uint32_t sky() const { return static_cast<std::uint32_t>(face_count()); }
  std::uint32_t ground_beyond() const { return sky() + 1; }
  std::uint32_t dark() const { return sky() + 2; }  // the ground from below
  std::size_t end_count() const { return face_count() + 3; }
  std::uint32_t met_by(const RayHit& hit) const;

  // Which object a surface is; kGround: local is the cell; kWood: the first segment of the group.
  RayStart object(std::size_t surface) const;
  // The segments of the group that starts with this one, as a range of the prototype's wood.
  SegmentRange wood_group(PrototypeId prototype, std::uint32_t first_segment) const;
  double area_m2(std::size_t surface) const { return area_m2_[surface]; }
  std::vector<SurfaceOptics> optics(const OpticsTable& table, std::size_t band) const;

  const Forest& forest() const { return forest_; }
  const ForestIndex& index() const { return index_; }
  const GroundCells& ground() const { return ground_; }

 private:
  std::size_t wood_surfaces(PrototypeId prototype) const;
  const WoodGroups& groups_of(std::size_t instance) const {
    return wood_groups_[forest_.instances[instance].prototype.value];
  }
  void add_foliage_areas();
  void add_wood_areas();

  const Forest& forest_;
  const GroundCells& ground_;
  ForestIndex index_;
  std::vector<WoodGroups> wood_groups_;  // of each prototype
  std::vector<std::size_t> wood_first_;  // of each instance among the wood surfaces
  std::vector<float> area_m2_;
};

}  // namespace sunfleck::trace
