#include "lighting/trace/ground_cells.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck::trace {
namespace {

struct Rectangle {
  Vec2 lo, size;
};

Rectangle covered(const Forest& forest) {
  if (forest.period) return {forest.period->origin_m, forest.period->size_m};
  const Box box = forest_bounds(forest);
  // Height above the lowest ground under the box, so that shadows of a sun at 45 degrees stay on the grid.
  double height = 0.0;
  for (const double x : {box.lo.x, box.hi.x})
    for (const double y : {box.lo.y, box.hi.y})
      height = std::max(height, box.hi.z - forest.terrain.height_at(x, y));
  const double widest = std::max(box.size().x, box.size().y);
  const double margin = std::max({height, 0.25 * widest, 1e-6});
  const Vec2 lo(box.lo.x - margin, box.lo.y - margin);
  return {lo, Vec2(box.hi.x + margin, box.hi.y + margin) - lo};
}

double automatic_cell_m(const Forest& forest, const Vec2& size) {
  const auto elements = static_cast<double>(ForestIndex(forest).element_count());
  const double cells = std::clamp(elements / 8.0, 256.0, 4096.0);
  return std::sqrt(size.x * size.y / cells);
}

}  // namespace

std::uint32_t GroundCells::cell_at(const Vec3& p) const {
  const double x = std::floor((p.x - lo_m.x) / cell_m.x), y = std::floor((p.y - lo_m.y) / cell_m.y);
  if (periodic) {
    const auto inside = [](double k, std::uint32_t n) {
      return static_cast<std::uint32_t>(std::clamp(k, 0.0, static_cast<double>(n) - 1.0));
    };
    return inside(y, ny) * nx + inside(x, nx);
  }
  if (!(x >= 0.0 && x < nx && y >= 0.0 && y < ny)) return count();
  return static_cast<std::uint32_t>(y) * nx + static_cast<std::uint32_t>(x);
}

GroundCells ground_cells_for(const Forest& forest, double wanted_cell_m) {
  const Rectangle area = covered(forest);
  const double cell = wanted_cell_m > 0.0 ? wanted_cell_m : automatic_cell_m(forest, area.size);
  const double nx = std::max(1.0, std::ceil(area.size.x / cell - 1e-9));
  const double ny = std::max(1.0, std::ceil(area.size.y / cell - 1e-9));
  if (nx * ny > 4e6)
    throw Error(ErrorKind::kLimitExceeded, "reference.ground_cell_m",
                "gives " + std::to_string(static_cast<long long>(nx * ny)) + " ground cells",
                "at most 4 million: " + std::to_string(std::sqrt(area.size.x * area.size.y / 4e6)) +
                    " m or more, or 0 to have it chosen");
  GroundCells cells;
  cells.nx = static_cast<std::uint32_t>(nx);
  cells.ny = static_cast<std::uint32_t>(ny);
  cells.lo_m = area.lo;
  cells.cell_m = {area.size.x / nx, area.size.y / ny};
  cells.normal = forest.terrain.normal();
  cells.periodic = forest.period.has_value();
  return cells;
}

}  // namespace sunfleck::trace
