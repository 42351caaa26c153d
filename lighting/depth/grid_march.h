// Optical depth along a ray through a grid of extinctions: extinction times the exact length in each cell.
#pragma once

#include <array>
#include <span>

#include "lighting/depth/grid_layout.h"

namespace sunfleck {

// Nothing gets through more than this: exp(-80) = 1.8e-35.
inline constexpr double kLargestDepth = 80.0;
// A ray that went around a periodic scene this often is out: it runs level.
inline constexpr int kMostWraps = 256;

// From a point inside `cell` along `direction` (in the frame of the layout; lengths count in its parameter)
// to the border, in [0, kLargestDepth]. `own_per_m` is taken out of the first cell.
double march_from_cell(const GridLayout& layout, std::span<const float> extinction_per_m,
                       const std::array<int, 3>& cell, const Vec3& point_m, const Vec3& direction,
                       float own_per_m);

// From any point, inside the grid or not.
double march_grid(const GridLayout& layout, std::span<const float> extinction_per_m, const Vec3& point_m,
                  const Vec3& direction);

}  // namespace sunfleck
