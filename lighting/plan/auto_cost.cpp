#include "lighting/plan/auto_cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "lighting/transport/grid_limits.h"
#include "lighting/transport/leaf_clumping.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

double clumping_of(const Prototype& prototype, double extent_m, double side_m) {
  constexpr double kCellsAcross = 32.0;
  if (!(extent_m > 0.0 && side_m > 0.0)) return 1.0;
  return transport::leaf_clumping(prototype, std::max(extent_m / kCellsAcross, 2.0 * side_m));
}

}  // namespace

SceneSizes scene_sizes(const Forest& forest) {
  SceneSizes s;
  std::vector<double> area(forest.prototypes.size()), moment(forest.prototypes.size());
  std::vector<double> extent_m(forest.prototypes.size()), clumping(forest.prototypes.size());
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const Prototype& prototype = forest.prototypes[p];
    s.prototype_parts +=
        static_cast<double>(prototype.foliage.size() + prototype.wood.size() + prototype.wood_mesh.size());
    Box centres;
    for (const FoliageElement& e : prototype.foliage) {
      centres.include(Vec3(e.centre_m));
      area[p] += e.area_m2;
      moment[p] += e.area_m2 * std::sqrt(e.area_m2);
    }
    extent_m[p] = std::max({centres.size().x, centres.size().y, centres.size().z});
    clumping[p] = area[p] > 0.0 ? clumping_of(prototype, extent_m[p], moment[p] / area[p]) : 1.0;
  }
  double areas = 0.0, moments = 0.0, extents = 0.0, clumpings = 0.0;
  for (const Instance& i : forest.instances) {
    const std::size_t p = i.prototype.value;
    const double scale = i.scale;
    s.elements += static_cast<double>(forest.prototypes[p].foliage.size());
    s.wood_faces +=
        2.0 * static_cast<double>(forest.prototypes[p].wood.size() + forest.prototypes[p].wood_mesh.size());
    areas += scale * scale * area[p];
    moments += scale * scale * scale * moment[p];
    extents += scale * scale * scale * area[p] * extent_m[p];
    clumpings += scale * scale * area[p] * clumping[p];
  }
  s.leaf_side_m = areas > 0.0 ? moments / areas : 0.0;
  s.tree_extent_m = areas > 0.0 ? extents / areas : 0.0;
  s.clumping = areas > 0.0 ? clumpings / areas : 1.0;
  Vec3 size = forest_bounds(forest).size();
  if (forest.period) size.x = forest.period->size_m.x, size.y = forest.period->size_m.y;
  s.volume_m3 = size.x * size.y * size.z;
  s.grid_cell_m = grid_cell_size(forest);
  return s;
}

double cells_of_grid(const SceneSizes& s, double cell_m) {
  const double cell = cell_m > 0.0 ? cell_m : s.grid_cell_m;
  return cell > 0.0 ? std::max(27.0, s.volume_m3 / (cell * cell * cell)) : 27.0;
}

double ray_scene_s(const SceneSizes& s) { return 0.4e-6 * s.prototype_parts + 0.1e-6 * s.elements; }

double probes_s(const ProbePlan& plan, std::size_t bands, bool with_groups) {
  const double rays = plan.count * (2.0 * plan.paths_per_face + 0.3 * plan.sun_rays);
  return (with_groups ? 2.0 : 1.0) * 0.8e-6 * rays * (0.8 + 0.2 * static_cast<double>(bands));
}

double grid_s(const SceneSizes& s, const GridOptions& o, std::size_t bands) {
  const double sweeps = 22e-9 * cells_of_grid(s, o.cell_m) * o.directions;
  const double each = static_cast<double>(bands);
  return 0.4e-6 * s.elements + sweeps * (0.4 + 0.6 * each) +
         s.elements * (0.2e-6 + 5e-9 * o.directions) * (0.5 + 0.5 * each);
}

double sun_drawing_s(const SceneSizes& s, double pixel_sides) {
  return s.elements * (0.2e-6 + 0.003e-6 / (pixel_sides * pixel_sides));
}

double links_s(const SceneSizes& s, int links, std::size_t bands) {
  const double faces = 2.0 * s.elements + s.wood_faces;
  return faces * links * (0.4e-6 + 0.012e-6 * static_cast<double>(bands));
}

double reference_s(const SceneSizes& s, int rays, std::size_t bands, bool sun) {
  const double faces = 2.0 * s.elements + s.wood_faces;
  return faces * rays * (0.45e-6 + (sun ? 0.14e-6 : 0.0) + 0.012e-6 * static_cast<double>(bands));
}

double machine_slowness() {
  constexpr double kNominal_s = 1.0e-3;
  const auto start = std::chrono::steady_clock::now();
  RandomStream random(1, 0, RandomPurpose::kProbeDraw);
  double sum = 0.0;
  for (int i = 0; i < 40000; ++i) sum += std::exp(-random.uniform());
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return sum > 0.0 ? std::clamp(took_s / kNominal_s, 0.1, 100.0) : 1.0;
}

}  // namespace sunfleck
