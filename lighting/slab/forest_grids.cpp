// Occupied cells of prototypes, numbered instance by instance; see forest_grids.h.
#include "lighting/slab/forest_grids.h"

#include <algorithm>

namespace sunfleck {
namespace {

Box centres(const Prototype& prototype) {
  Box box;
  for (const FoliageElement& e : prototype.foliage) box.include(Vec3(e.centre_m));
  return box;
}

// Cells in the order of their place in the box, so that neighbours in space are neighbours in memory.
void number_cells(const Prototype& prototype, const Box& box, int resolution, PrototypeGrid& grid) {
  const auto side = static_cast<std::size_t>(resolution);
  const auto step = [&](double v, double lo) {
    const double cell = grid.cell_m > 0.0 ? (v - lo) / grid.cell_m : 0.0;
    return static_cast<std::size_t>(std::clamp(cell, 0.0, resolution - 1.0));
  };
  constexpr std::uint32_t kEmpty = ~0u;
  std::vector<std::uint32_t> number(side * side * side, kEmpty);
  for (const FoliageElement& e : prototype.foliage) {
    const Vec3 c(e.centre_m);
    const std::size_t place = (step(c.z, box.lo.z) * side + step(c.y, box.lo.y)) * side + step(c.x, box.lo.x);
    grid.cell_of_element.push_back(static_cast<std::uint32_t>(place));
    number[place] = 0;
  }
  std::uint32_t cells = 0;
  for (std::uint32_t& n : number)
    if (n != kEmpty) n = cells++;
  for (std::uint32_t& cell : grid.cell_of_element) cell = number[cell];
  grid.first.assign(cells + 1, 0);
  grid.centre_m.assign(cells, Vec3(0.0));
}

}  // namespace

PrototypeGrid make_prototype_grid(const Prototype& prototype, int resolution) {
  PrototypeGrid grid;
  const Box box = centres(prototype);
  const Vec3 size = box.size();
  grid.cell_m = std::max({size.x, size.y, size.z}) / resolution;
  number_cells(prototype, box, resolution, grid);
  for (const std::uint32_t cell : grid.cell_of_element) ++grid.first[cell + 1];
  for (std::size_t c = 1; c < grid.first.size(); ++c) grid.first[c] += grid.first[c - 1];
  grid.elements.resize(prototype.foliage.size());
  std::vector<std::uint32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (std::uint32_t e = 0; e < prototype.foliage.size(); ++e) {
    const std::uint32_t cell = grid.cell_of_element[e];
    grid.elements[next[cell]++] = e;
    grid.centre_m[cell] += Vec3(prototype.foliage[e].centre_m);
  }
  for (std::size_t c = 0; c < grid.cells(); ++c)
    grid.centre_m[c] /= static_cast<double>(grid.first[c + 1] - grid.first[c]);
  return grid;
}

CellCentres::CellCentres(const PrototypeGrid& grid) {
  for (const Vec3& c : grid.centre_m) {
    x.push_back(static_cast<float>(c.x));
    y.push_back(static_cast<float>(c.y));
    z.push_back(static_cast<float>(c.z));
  }
}

ForestGrids make_forest_grids(const Forest& forest, int resolution) {
  ForestGrids grids;
  for (const Prototype& prototype : forest.prototypes)
    grids.prototypes.push_back(make_prototype_grid(prototype, resolution));
  grids.first_cell.push_back(0);
  for (const Instance& instance : forest.instances)
    grids.first_cell.push_back(grids.first_cell.back() + grids.prototypes[instance.prototype.value].cells());
  return grids;
}

std::size_t ForestGrids::instance_of(std::size_t cell) const {
  const auto after = std::upper_bound(first_cell.begin(), first_cell.end(), cell);
  return static_cast<std::size_t>(after - first_cell.begin()) - 1;
}

}  // namespace sunfleck
