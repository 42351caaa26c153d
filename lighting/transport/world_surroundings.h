// What a tree's fine grid sees of the world around it: other trees' medium and the radiance at every point
// near it, in a block of world cells. Points are in the world grid's frame and cells numbered in it, both
// without going back into the period. See world_light.h.
#pragma once

#include <algorithm>
#include <cmath>

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
  Vec3 centre(std::size_t block_cell) const;
  const std::array<int, 3>& lo() const { return lo_; }
  const std::array<int, 3>& size() const { return size_; }
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

// between() for the cells of a finer grid, prepared for many looks. The finer grid's axes are the world's;
// its frame starts at `origin_m` of the world. A point's height in the world grid's frame may depend on its
// place.
class BlockLookup {
 public:
  BlockLookup(const Surroundings& around, const WorldScene& scene, const GridLayout& fine,
              const Vec3& origin_m);

  // For indexes from -1 to the number of cells.
  float value(const float* field, const std::array<int, 3>& cell) const {
    const Part &x = x_[static_cast<std::size_t>(cell[0] + 1)], &y = y_[static_cast<std::size_t>(cell[1] + 1)];
    const float at = height_[static_cast<std::size_t>(cell[2] + 1)] - x.sinks - y.sinks;
    const float low = std::clamp(std::floor(at), 0.0f, highest_);
    const float z = std::clamp(at - low, 0.0f, 1.0f);
    const float* f = field + static_cast<std::size_t>(low) * plane_ + y.low + x.low;
    const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
    const auto row = [&](const float* r) { return mix(r[0], r[1], x.part); };
    const auto layer = [&](const float* p) { return mix(row(p), row(p + row_), y.part); };
    return mix(layer(f), layer(f + plane_), z);
  }

 private:
  struct Part {
    std::size_t low = 0;  // first of two cells, in values of the field
    float part = 0;       // weight of the second
    float sinks = 0;      // cells of height per place, on a slope
  };
  std::vector<Part> along(int axis, const Surroundings& around, const WorldScene& scene,
                          const GridLayout& fine, const Vec3& origin_m, std::size_t stride) const;

  std::size_t row_, plane_;
  float highest_;
  std::vector<Part> x_, y_;
  std::vector<float> height_;
};

// [direction][cell of the block]; beyond the world grid what `outside` brings, one per direction.
std::vector<float> block_radiance(const WorldScene& scene, const Surroundings& around,
                                  const std::vector<float>& radiance,
                                  const std::vector<WorldInflow>& outside);

}  // namespace sunfleck::transport
