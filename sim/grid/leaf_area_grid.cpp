// Sorts the elements by cell and sums their areas in double: the result does not depend on OpenVDB, threads
// or the order of cells. Good as long as elements are smaller than a cell (the cell rule sees to it).

#include "sim/grid/leaf_area_grid.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {

namespace {

// Side of the square that is as large as the element's outline.
double outline_side_m(const FoliageElement& element) {
  const double edges =
      static_cast<double>(glm::length(element.half_u_m)) * static_cast<double>(glm::length(element.half_v_m));
  return std::sqrt(element.shape == ElementShape::kTriangle ? 0.5 * edges : 4.0 * edges);
}

Box centre_box(const Prototype& prototype) {
  Box box;
  for (const FoliageElement& element : prototype.foliage) box.include(Vec3(element.centre_m));
  return box;
}

struct Deposit {
  std::array<std::int32_t, 3> cell;
  double area_m2;
};

std::vector<Deposit> sorted_deposits(const Prototype& prototype, double cell_m) {
  std::vector<Deposit> deposits;
  deposits.reserve(prototype.foliage.size());
  for (const FoliageElement& element : prototype.foliage) {
    const Vec3 cell = glm::floor(Vec3(element.centre_m) / cell_m);
    deposits.push_back({{static_cast<std::int32_t>(cell.x), static_cast<std::int32_t>(cell.y),
                         static_cast<std::int32_t>(cell.z)},
                        static_cast<double>(element.area_m2)});
  }
  std::stable_sort(deposits.begin(), deposits.end(),
                   [](const Deposit& a, const Deposit& b) { return a.cell < b.cell; });
  return deposits;
}

}  // namespace

double leaf_area_cell_m(const Prototype& prototype) {
  if (prototype.foliage.empty()) return 1.0;
  double side_m = 0;
  for (const FoliageElement& element : prototype.foliage) side_m += outline_side_m(element);
  side_m /= static_cast<double>(prototype.foliage.size());
  const Box box = centre_box(prototype);
  const double extent_m = std::max({box.size().x, box.size().y, box.size().z});
  const double wanted_m = std::clamp(extent_m / 32.0, 2.0 * side_m, 4.0 * side_m);
  // Cell indexes are 32 bits and OpenVDB refuses voxels of no volume: elements far from the origin, or
  // without size, still get a grid.
  const double reach_m = std::max(glm::length(box.lo), glm::length(box.hi));
  return std::max({wanted_m, reach_m * 1e-6, 1e-4});
}

DensityGrid leaf_area_grid(const Prototype& prototype, const std::string& name) {
  DensityGrid grid;
  grid.name = name;
  grid.about = "one-sided leaf area density (m2/m3) of " + prototype.name;
  grid.cell_m = leaf_area_cell_m(prototype);
  const double cell_volume_m3 = grid.cell_m * grid.cell_m * grid.cell_m;
  const std::vector<Deposit> deposits = sorted_deposits(prototype, grid.cell_m);
  for (std::size_t i = 0; i < deposits.size();) {
    const auto cell = deposits[i].cell;
    double area_m2 = 0;
    for (; i < deposits.size() && deposits[i].cell == cell; ++i) area_m2 += deposits[i].area_m2;
    grid.cells.push_back({cell, static_cast<float>(area_m2 / cell_volume_m3)});
    grid.integral += area_m2;
  }
  return grid;
}

}  // namespace sunfleck
