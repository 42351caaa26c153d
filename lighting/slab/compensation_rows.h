// G of many cells at once, from their depths in all sample directions: compensation() in vector code.
#pragma once

#include <span>

#include "lighting/slab/cell_depths.h"

namespace sunfleck {

// G for light from `to_light` of cells [begin, end), written to `result`; `before`, `behind` and `result` are
// of all cells. Absolute error against compensation() below 5e-6.
void compensation_rows(const CellDepths& cells, const Vec3& to_light, std::span<const float> before,
                       std::span<const float> behind, std::size_t begin, std::size_t end,
                       std::span<float> result);

}  // namespace sunfleck
