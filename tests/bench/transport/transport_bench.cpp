// Time of the grid method on one core: all of it by leaves and directions, a sweep per cell, an order of
// scattering per leaf. The answer's mean sunlit share is checked against the ball's closed form and its
// furnace against 1 before anything is timed.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "lighting/transport/band_solver.h"
#include "lighting/transport/grid_estimator.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.45, 0.25, 0.86));

Illumination sky_and_sun() {
  Illumination light;
  light.to_sun = kSun;
  light.bands = {{900, 100}};
  return light;
}

OpticsTable near_infrared(const Forest& forest) {
  return OpticsTable(forest, {.bands = {"NIR"}, .soil_albedo = {0.2}, .overrides = {}});
}

// Nothing absorbs and the sky is 1: so is the light of every face.
bool furnace_is_even() {
  Forest forest = generated_crown({.leaves = 2000, .crown_lai = 3});
  forest.materials[0].bands = {{"NIR", 0.5, 0.5, 1}};
  Illumination light;
  light.bands = {{0, 1}};
  const OpticsTable optics(forest, {.bands = {"NIR"}, .soil_albedo = {1.0}, .overrides = {}});
  const LightMap map =
      grid_light_map(forest, optics, light, {.convergence = 1e-6, .max_iterations = 1000}, {});
  for (const ElementLight& e : map.bands[0].elements)
    if (std::abs(e.front.total() - 1) > 1e-3 || std::abs(e.back.total() - 1) > 1e-3) return false;
  return true;
}

// Mean sunlit share of a ball of LAI 5: (1 - T) / 2.5, T = 0.12633.
bool plausible(const LightMap& map) {
  double sunlit = 0.0;
  for (const float s : map.sunlit_fraction) sunlit += s / static_cast<double>(map.sunlit_fraction.size());
  return std::abs(sunlit / 0.34947 - 1) < 0.05;
}

void estimator(benchmark::State& state) {
  const Forest forest = generated_crown({.leaves = static_cast<int>(state.range(0)), .crown_lai = 5});
  const OpticsTable optics = near_infrared(forest);
  const GridOptions options{.directions = static_cast<int>(state.range(1))};
  LightMap map = grid_light_map(forest, optics, sky_and_sun(), options, {});
  if (!plausible(map) || !furnace_is_even()) return state.SkipWithError("wrong answer");
  std::map<std::string, double> stages;
  for (auto _ : state) {
    with_threads(1, [&] { map = grid_light_map(forest, optics, sky_and_sun(), options, {}); });
    for (const StageTime& t : map.provenance.times) stages[t.stage] += t.wall_s;
  }
  for (const auto& [stage, seconds] : stages)
    state.counters[stage + "_ms"] = 1e3 * seconds / static_cast<double>(state.iterations());
  for (const auto& [name, value] : map.provenance.settings)
    if (name == "cells" || name == "iterations") state.counters[name] = std::stod(value);
}
BENCHMARK(estimator)
    ->ArgNames({"leaves", "directions"})
    ->ArgsProduct({{1500, 40000, 160000, 640000}, {8, 14, 26}})
    ->Unit(benchmark::kMillisecond);

// One sweep of one direction along each axis.
void one_sweep(benchmark::State& state) {
  const Forest forest = generated_crown({.leaves = 40000, .crown_lai = 5});
  const ForestIndex index(forest);
  const transport::TransportScene scene =
      transport::transport_scene(forest, index, transport::cubic_directions(26), {}, {});
  Vec3 towards(0);
  towards[static_cast<int>(state.range(0))] = 1;
  std::size_t direction = 0;
  while (scene.set.to_source[direction] != towards) ++direction;
  std::vector<float> radiance(scene.cells(), 0.5f), around;
  for (auto _ : state)
    transport::sweep(scene.plans[direction], scene.transmittance_of(direction), transport::NoInflow(),
                     radiance, around, {});
  state.counters["per_cell"] =
      benchmark::Counter(static_cast<double>(scene.cells()) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(one_sweep)->ArgName("axis")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

void one_order_of_scattering(benchmark::State& state) {
  const Forest forest = generated_crown({.leaves = 40000, .crown_lai = 5});
  const ForestIndex index(forest);
  const OpticsTable optics = near_infrared(forest);
  const transport::TransportScene scene =
      transport::transport_scene(forest, index, transport::cubic_directions(26), {}, {});
  const double face_m2 = std::pow(scene.field->layout().mean_cell_m(), 2);
  const transport::LeafScattering leaves(scene.contents, scene.lanes, scene.set.half(), face_m2,
                                         transport::leaf_bands(forest, optics, 0), 0.0);
  std::vector<float> radiance(scene.set.count() * scene.cells(), 0.5f), source(radiance.size());
  transport::Orders orders;
  with_threads(1, [&] {
    for (auto _ : state) leaves.next_order(radiance, 1.0, {}, orders, source, {});
  });
  state.counters["per_leaf"] = benchmark::Counter(40000.0 * static_cast<double>(state.iterations()),
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(one_order_of_scattering)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunfleck
