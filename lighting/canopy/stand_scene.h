// A forest made ready for stand light: rays, the ground map, layers and the leaf area of trees and layers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lighting/trace/ray_scene.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct StandSceneOptions {
  double ground_cell_m = 5;  // wanted edge of a ground cell; the map gets a whole number of them
  // Part of the ground that is mapped and that shares (transmittance, profile) refer to. Periodic forests:
  // always the period. Else, where not given, the forest's bounds.
  std::optional<Vec2> map_lo_m, map_hi_m;
  double layer_m = 1;  // thickness of height layers
};

// Cells of the ground plane, row by row from the south-west corner: index = y * nx + x.
struct StandGround {
  Vec2 lo_m{0}, cell_m{1};
  std::uint32_t nx = 1, ny = 1;
  Vec3 normal{0, 0, 1};
  bool periodic = false;

  std::size_t count() const { return static_cast<std::size_t>(nx) * ny; }
  Vec2 size_m() const { return {cell_m.x * nx, cell_m.y * ny}; }
  double cell_area_m2() const { return cell_m.x * cell_m.y; }  // seen from above
  Vec2 centre_m(std::size_t cell) const {
    return lo_m + cell_m * (Vec2(static_cast<double>(cell % nx), static_cast<double>(cell / nx)) + 0.5);
  }
  bool contains(double x_m, double y_m) const;
  // Cell under a point (periodic: of the base period); count() beyond the map.
  std::size_t cell_at(double x_m, double y_m) const;
  // m2 of light from `to_source` that one m2 of the map, seen from above, catches; 0 from below the ground.
  double facing(const Vec3& to_source) const {
    const double cosine = glm::dot(to_source, normal);
    return to_source.z > 0.0 && cosine > 0.0 ? cosine / normal.z : 0.0;
  }
};

class StandScene {
 public:
  // `forest` must outlive it. Throws Error(kInvalidInput): forest without trees, cell or layer not positive,
  // map corners the wrong way round; Error(kLimitExceeded): more than 4 million ground cells or 10,000
  // layers.
  StandScene(const Forest& forest, const StandSceneOptions& options, const RunControl& control = {});

  const Forest& forest() const { return forest_; }
  const RayScene& rays() const { return *rays_; }
  const StandGround& ground() const { return ground_; }
  double layer_m() const { return layer_m_; }
  std::size_t layer_count() const { return layer_leaf_area_m2_.size(); }
  std::size_t layer_at(const Vec3& point_m) const;  // by height above the ground plane
  double height_above_ground(const Vec3& p) const { return p.z - forest_.terrain.height_at(p.x, p.y); }
  const Box& bounds() const { return bounds_; }
  // Where light is asked for: everything; in a forest that does not repeat and has surroundings (trees with
  // virtual numbers, which nobody measured), the map and the other trees, half the forest's height beyond
  // them for what is scattered in from the side.
  const Box& region() const { return region_; }
  bool has_surroundings() const { return has_surroundings_; }
  // Is anything asked about the tree? Of surroundings only if there is nothing else.
  bool is_asked(std::size_t instance) const { return asked_[instance] != 0; }
  double ceiling_m() const { return ceiling_m_; }  // above the ground plane, nothing stands higher
  const std::vector<double>& tree_leaf_area_m2() const { return tree_leaf_area_m2_; }
  const std::vector<double>& layer_leaf_area_m2() const { return layer_leaf_area_m2_; }

 private:
  void fit_ground(const StandSceneOptions& options);
  void measure_height();
  void choose_region();
  void sum_leaf_area();

  const Forest& forest_;
  StandGround ground_;
  Box bounds_, region_;
  bool has_surroundings_ = false;
  std::vector<char> asked_;
  double layer_m_, ceiling_m_ = 0;
  std::vector<double> tree_leaf_area_m2_, layer_leaf_area_m2_;
  std::unique_ptr<RayScene> rays_;
};

}  // namespace sunfleck
