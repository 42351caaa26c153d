// What a tree's fine grid sees of the world around it: other trees' medium and the radiance at every point
// near it, in a block of world cells. Points are in the world grid's frame and cells numbered in it, both
// without going back into the period. See world_light.h.
#pragma once

#include "lighting/transport/world_solver.h"

namespace sunfleck::transport {

class Surroundings {
 public:
  // `covered`: box of what the fine grid covers.
  Surroundings(const WorldScene& scene, const WorldSources& sources, const Instance& instance,
               const Box& covered);

  std::size_t count() const { return cells_.size(); }
  // Cell of the world grid for every cell of the block, none outside the grid.
  const std::vector<std::optional<std::uint32_t>>& cells() const { return cells_; }
  std::array<int, 3> place(std::size_t block_cell) const;
  std::uint32_t block_cell(const Vec3& point_m) const;

  // Effective areas of all but the tree itself, for every cell of the block.
  const std::vector<std::vector<WorldEntry>>& others() const { return others_; }
  double sun_depth_of_others(const Vec3& point_m, const Vec3& towards) const;

  // Trilinear between cell centres; `field` has one value per cell of the block.
  float between(const float* field, const Vec3& point_m) const;

 private:
  const WorldScene& scene_;
  const WorldSources& sources_;
  std::array<int, 3> lo_{}, size_{};
  std::vector<std::optional<std::uint32_t>> cells_;
  std::vector<std::vector<WorldEntry>> others_;
  GridLayout own_layout_;
  std::vector<float> own_sun_extinction_per_m_;
};

// [direction][cell of the block]; beyond the world grid what `outside` brings, one per direction.
std::vector<float> block_radiance(const WorldScene& scene, const Surroundings& around,
                                  const std::vector<float>& radiance,
                                  const std::vector<WorldInflow>& outside);

}  // namespace sunfleck::transport
