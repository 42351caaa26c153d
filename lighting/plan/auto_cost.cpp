#include "lighting/plan/auto_cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "lighting/depth/grid_layout.h"
#include "sim/base/random.h"

namespace sunfleck {

SceneSizes scene_sizes(const Forest& forest) {
  SceneSizes s;
  std::vector<double> area(forest.prototypes.size()), moment(forest.prototypes.size());
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const Prototype& prototype = forest.prototypes[p];
    s.prototype_parts +=
        static_cast<double>(prototype.foliage.size() + prototype.wood.size() + prototype.wood_mesh.size());
    for (const FoliageElement& e : prototype.foliage) {
      area[p] += e.area_m2;
      moment[p] += e.area_m2 * std::sqrt(e.area_m2);
    }
  }
  double areas = 0.0, moments = 0.0;
  for (const Instance& i : forest.instances) {
    const std::size_t p = i.prototype.value;
    const double scale = i.scale;
    s.elements += static_cast<double>(forest.prototypes[p].foliage.size());
    s.wood_faces +=
        2.0 * static_cast<double>(forest.prototypes[p].wood.size() + forest.prototypes[p].wood_mesh.size());
    areas += scale * scale * area[p];
    moments += scale * scale * scale * moment[p];
  }
  s.leaf_side_m = areas > 0.0 ? moments / areas : 0.0;
  Vec3 size = forest_bounds(forest).size();
  if (forest.period) size.x = forest.period->size_m.x, size.y = forest.period->size_m.y;
  s.volume_m3 = size.x * size.y * size.z;
  s.extent_m = std::max({size.x, size.y, size.z});
  return s;
}

double cells_of_grid(const SceneSizes& s, double cell_m) {
  const double cell = cell_m > 0.0 ? cell_m : leaf_cell_size(s.extent_m, s.leaf_side_m);
  return cell > 0.0 ? std::max(27.0, s.volume_m3 / (cell * cell * cell)) : 27.0;
}

// Sky and scattered radiance per direction, transmittance for half of them, as transport_scene.cpp counts.
std::uint64_t grid_bytes(double cells, int directions) {
  return static_cast<std::uint64_t>(cells * (10.0 * directions + 4.0));
}

double ray_scene_s(const SceneSizes& s) { return 0.4e-6 * s.prototype_parts + 0.1e-6 * s.elements; }

double probes_s(const ProbePlan& plan, std::size_t bands, bool with_groups) {
  const double rays = plan.count * (2.0 * plan.paths_per_face + 0.3 * plan.sun_rays);
  return (with_groups ? 2.0 : 1.0) * 0.8e-6 * rays * (0.8 + 0.2 * static_cast<double>(bands));
}

double grid_s(const SceneSizes& s, const GridOptions& o, std::size_t bands) {
  const double sweeps = 22e-9 * cells_of_grid(s, o.cell_m) * o.directions;
  const double each = static_cast<double>(bands);
  return 0.6e-6 * s.elements + sweeps * (0.4 + 0.6 * each) +
         s.elements * (0.4e-6 + 5e-9 * o.directions) * (0.5 + 0.5 * each);
}

double sun_drawing_s(const SceneSizes& s, double target_error) {
  return s.elements * (0.65e-6 + 0.012e-6 * std::pow(target_error, -4.0 / 3.0));
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

std::vector<GridOptions> grid_rungs(const SceneSizes& s, const GridOptions& asked, double tolerance) {
  const GridOptions usual;
  if (asked.directions != usual.directions || asked.cell_m != usual.cell_m ||
      asked.convergence != usual.convergence || asked.max_iterations != usual.max_iterations)
    return {asked};
  constexpr double kLarge = 200000, kTight = 0.12;
  const bool fine_only = s.elements >= kLarge && tolerance > 0.0 && tolerance <= kTight;
  const double convergence = tolerance > 0.0 ? 0.1 * std::min(0.2, tolerance) : 0.01;
  std::vector<GridOptions> rungs;
  for (const auto& [directions, sides] : {std::pair{14, 3.0}, {26, 3.0}, {26, 2.0}})
    if (!fine_only || sides < 3.0)
      rungs.push_back(
          {.directions = directions, .cell_m = sides * s.leaf_side_m, .convergence = convergence});
  return rungs;
}

}  // namespace sunfleck
