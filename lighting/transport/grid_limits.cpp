// See grid_limits.h.
#include "lighting/transport/grid_limits.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lighting/depth/blocker_field.h"
#include "lighting/depth/grid_frame.h"
#include "lighting/transport/leaf_clumping.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace {

constexpr double kCellsAcross = 32.0;  // a tree, as leaf_cell_size() has it
// Clumps blur in cells not much smaller than they: cells finer by the clumping of the leaves, up to this.
constexpr double kFinestForClumps = 1.4;
// Cells in the box around a tree, where cells of 4 sides would be more: crowns of 200,000 leaves and more.
constexpr double kMostCellsPerLeaf = 0.65;

std::string number(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

// Sums over a prototype in its own size: area, and area times side.
struct SideSums {
  double area_m2 = 0, weighted_side_m3 = 0;
};

SideSums side_sums(const Prototype& prototype) {
  SideSums sums;
  for (const FoliageElement& e : prototype.foliage) {
    FieldElement element;
    element.area_m2 = e.area_m2;
    if (e.shape == ElementShape::kShoot) {
      element.axis = e.half_u_m;
      element.shoot_radius_m = glm::length(e.half_v_m);
    }
    sums.area_m2 += e.area_m2;
    sums.weighted_side_m3 += e.area_m2 * element_side_m(element);
  }
  return sums;
}

// Of leaves and trees of a forest, each by its leaf area.
struct MeanTree {
  double leaf_side_m = 0, extent_m = 0, box_per_leaf_m3 = 0, clumping = 1;
};

double largest(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

double clumping_of(const Prototype& prototype, const SideSums& sums, const Vec3& size_m) {
  if (!(sums.area_m2 > 0.0 && largest(size_m) > 0.0)) return 1.0;
  const double side_m = sums.weighted_side_m3 / sums.area_m2;
  return transport::leaf_clumping(prototype, std::max(largest(size_m) / kCellsAcross, 2.0 * side_m));
}

MeanTree mean_tree(const Forest& forest) {
  std::vector<SideSums> of_prototype;
  std::vector<Vec3> size_m;
  std::vector<double> clumping;
  for (const Prototype& p : forest.prototypes) {
    of_prototype.push_back(side_sums(p));
    size_m.push_back(p.foliage.empty() ? Vec3(0) : prototype_bounds(p).size());
    clumping.push_back(clumping_of(p, of_prototype.back(), size_m.back()));
  }
  MeanTree mean{.clumping = 0.0};
  double area_m2 = 0.0;
  for (const Instance& i : forest.instances) {
    const std::size_t p = i.prototype.value;
    const double scale = i.scale, area = scale * scale * of_prototype[p].area_m2;
    area_m2 += area;
    mean.leaf_side_m += scale * scale * scale * of_prototype[p].weighted_side_m3;
    mean.extent_m += area * scale * largest(size_m[p]);
    mean.clumping += area * clumping[p];
    if (area > 0.0)
      mean.box_per_leaf_m3 += area * std::pow(scale, 3) * size_m[p].x * size_m[p].y * size_m[p].z /
                              static_cast<double>(forest.prototypes[p].foliage.size());
  }
  if (!(area_m2 > 0.0)) return {};
  return {mean.leaf_side_m / area_m2, mean.extent_m / area_m2, mean.box_per_leaf_m3 / area_m2,
          mean.clumping / area_m2};
}

// Not from the extent of the whole forest: cells of 4 sides for a stand whose crowns alone get 2 let 5 to 8 %
// too much light through clumped crowns.
double cell_of_mean_tree(const MeanTree& tree) {
  if (!(tree.extent_m > 0.0 && tree.leaf_side_m > 0.0)) return 0.0;
  const double wanted = tree.extent_m / (kCellsAcross * std::clamp(tree.clumping, 1.0, kFinestForClumps));
  if (wanted <= kMostSides * tree.leaf_side_m) return std::max(wanted, 2.0 * tree.leaf_side_m);
  const double few_per_leaf = std::cbrt(tree.box_per_leaf_m3 / kMostCellsPerLeaf);
  return std::max(kMostSides * tree.leaf_side_m, std::min(wanted, few_per_leaf));
}

Box field_bounds(const Forest& forest, const GridFrame& frame) {
  const Box world = forest_bounds(forest);
  Box box;
  for (const double x : {world.lo.x, world.hi.x})
    for (const double y : {world.lo.y, world.hi.y})
      for (const double z : {world.lo.z, world.hi.z}) box.include(frame.unwrapped_from_world({x, y, z}));
  return box;
}

double rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return std::ceil(value / unit) * unit;
}

}  // namespace

void check_grid_options(const GridOptions& o) {
  if (o.directions != 8 && o.directions != 14 && o.directions != 26)
    throw_invalid("grid.directions", std::to_string(o.directions) + " directions are not built",
                  "8, 14 or 26");
  if (!(o.cell_m >= 0.0 && std::isfinite(o.cell_m)))
    throw_invalid("grid.cell_m", "a cell cannot be " + number(o.cell_m) + " m",
                  "a length in metres, best 2 to 4 leaf sides, or 0 to have it chosen");
  if (o.memory_limit_bytes < (1ull << 20))
    throw_invalid("grid.memory_limit_bytes", std::to_string(o.memory_limit_bytes) + " bytes hold no grid",
                  "at least 1048576; 1610612736 is usual");
  if (!(o.convergence > 0.0 && o.convergence <= 0.5))
    throw_invalid("grid.convergence", number(o.convergence) + " is out of range",
                  "more than 0, at most 0.5; 0.002 is usual");
  if (o.max_iterations < 1 || o.max_iterations > 10000)
    throw_invalid("grid.max_iterations", std::to_string(o.max_iterations) + " is out of range", "1 to 10000");
}

std::uint64_t grid_bytes(std::uint64_t cells, std::uint64_t elements, int directions) {
  // Sky, light on its way and, for half the directions, transmittance; 16 directions stand for 14.
  const std::uint64_t floats = 5ull * static_cast<std::uint64_t>((directions == 14 ? 16 : directions) / 2);
  // And for the light of leaves radiance once more, cell by cell.
  constexpr std::uint64_t kByCell = 128;
  return cells * (sizeof(float) * floats + kByCell + sizeof(std::uint32_t)) + elements * 200;
}

double grid_cell_size(const Forest& forest) { return cell_of_mean_tree(mean_tree(forest)); }

GridSuitability grid_suitability(const Forest& forest, const GridOptions& options) {
  check_grid_options(options);
  GridSuitability s;
  const std::uint64_t elements = ForestIndex(forest).element_count();
  const MeanTree tree = mean_tree(forest);
  s.leaf_side_m = tree.leaf_side_m;
  if (elements == 0) return s;
  const GridFrame frame = grid_frame(forest);
  const Box box = field_bounds(forest, frame);
  const double extent = std::max({box.size().x, box.size().y, box.size().z});
  const double side = s.leaf_side_m > 0.0 ? s.leaf_side_m : extent / 64.0;
  const double chosen = cell_of_mean_tree(tree);
  const double wanted = options.cell_m > 0.0 ? options.cell_m
                        : chosen > 0.0       ? chosen
                                             : leaf_cell_size(extent, side);
  const std::uint64_t per_cell = grid_bytes(1, 0, options.directions);
  const std::uint64_t of_elements = grid_bytes(0, elements, options.directions);
  const std::uint64_t fitting =
      options.memory_limit_bytes > of_elements ? (options.memory_limit_bytes - of_elements) / per_cell : 0;
  const std::uint64_t most = std::clamp<std::uint64_t>(fitting, 27, 1ull << 31);
  const GridLayout layout = fit_grid(box, frame.period_box(), wanted, most);
  s.smallest_cell_m =
      rounded_up(fit_grid(box, frame.period_box(), 1e-6 * extent + 1e-12, most).mean_cell_m());
  s.fits = options.cell_m == 0.0 || (!layout.coarsened && fitting >= 27);
  const GridLayout used = s.fits ? layout : fit_grid(box, frame.period_box(), wanted, (1ull << 32) - 1);
  s.cell_m = s.fits ? used.mean_cell_m() : wanted;
  // Beyond 4e9 cells by volume: they are only told, never made.
  s.cells = s.fits || !used.coarsened
                ? used.cell_count()
                : static_cast<std::uint64_t>(std::min(1e18, static_cast<double>(used.cell_count()) *
                                                                std::pow(used.mean_cell_m() / wanted, 3)));
  s.bytes = grid_bytes(s.cells, elements, options.directions);
  s.cell_sides = s.cell_m / side;
  for (const Prototype& p : forest.prototypes)
    if (!p.foliage.empty() && (s.fewest_elements == 0 || p.foliage.size() < s.fewest_elements))
      s.fewest_elements = p.foliage.size();
  s.few_elements = s.fewest_elements < kFewElements;
  s.small_cells = s.cell_sides < kFewestSides;
  s.coarse_cells = s.cell_sides > kMostSides * 1.001;
  return s;
}

void check_grid_fits(const Forest& forest, const GridOptions& options) {
  check_grid_options(options);
  if (!(options.cell_m > 0.0)) return;
  const GridSuitability s = grid_suitability(forest, options);
  if (s.fits) return;
  std::ostringstream problem, remedy;
  problem << "cells of " << options.cell_m << " m need " << s.bytes << " bytes (" << s.cells
          << " cells); the limit is " << options.memory_limit_bytes;
  remedy << "at least " << s.smallest_cell_m
         << " m, 0 to have it chosen, or a higher grid.memory_limit_bytes";
  throw Error(ErrorKind::kLimitExceeded, "grid.cell_m", problem.str(), remedy.str());
}

}  // namespace sunfleck
