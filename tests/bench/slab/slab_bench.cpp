// Nanoseconds of one closed form, and seconds of the estimators on crowns and stands. Each bench checks the
// answer before it is timed.
#include <benchmark/benchmark.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "lighting/base/summaries.h"
#include "lighting/slab/compensation.h"
#include "lighting/slab/spp.h"
#include "lighting/slab/spp_estimators.h"
#include "lighting/slab/spp_h.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

constexpr std::size_t kPoints = 1024;

std::vector<double> depths() {
  RandomStream random(1, 0, RandomPurpose::kTestScene);
  std::vector<double> values;
  for (std::size_t i = 0; i < kPoints; ++i) values.push_back(std::exp(random.uniform(-4.0, 3.0)));
  return values;
}

void require(bool right, const char* what) {
  if (!right) throw std::runtime_error(what);
}

template <class Real>
void closed_form(benchmark::State& state) {
  const std::vector<double> d = depths();
  const std::vector<Real> depth(d.begin(), d.end());
  const SlabMedium<Real> medium{Real(0.1), Real(0.6), Real(0.2)};
  const auto probe = spp(Real(1), Real(2), SlabMedium<Real>{Real(0), Real(0.5), Real(0)});
  require(std::abs(static_cast<double>(probe.direct + probe.down - probe.up) - 1 / 2.5) < 1e-6,
          "net flux of a white slab of depth 3 is not 1 / (1 + 3/2)");
  for (auto _ : state)
    for (std::size_t i = 0; i < kPoints; ++i)
      benchmark::DoNotOptimize(spp(depth[i], depth[kPoints - 1 - i], medium));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kPoints));
}
BENCHMARK(closed_form<double>);
BENCHMARK(closed_form<float>);

void closed_form_h(benchmark::State& state) {
  const std::vector<double> depth = depths();
  for (auto _ : state)
    for (std::size_t i = 0; i < kPoints; ++i)
      benchmark::DoNotOptimize(spp_h(depth[i], depth[kPoints - 1 - i], {0.1, 0.6, 0.55, 0.2, 0.7}));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kPoints));
}
BENCHMARK(closed_form_h);

void shortfall(benchmark::State& state) {
  const std::vector<double> depth = depths();
  for (auto _ : state)
    for (std::size_t i = 0; i < kPoints; ++i)
      benchmark::DoNotOptimize(
          compensation_shortfall(depth[i], depth[kPoints - 1 - i], 0.7, i % 2 ? 0.6 : -0.6));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kPoints));
}
BENCHMARK(shortfall);

Forest stand(int side) {
  Forest forest = generated_crown({CrownKind::kSphere, 1000, 2.0, 3.0, 1});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  for (int i = 0; i < side * side; ++i) {
    Instance tree = first;
    tree.position_m += Vec3(4.2 * (i % side), 4.2 * (i / side), 0.0);
    tree.yaw_rad = static_cast<float>(0.37 * i);
    forest.instances.push_back(tree);
  }
  return forest;
}

// Sun and overcast sky, two bands.
void estimate(benchmark::State& state, const Forest& forest, SppVariant variant) {
  const OpticsTable optics(forest, {{"PAR", "NIR"}, {0.1, 0.2}, {}});
  Illumination light;
  light.to_sun = direction_from_azimuth_zenith(1.0, radians_from_degrees(40.0));
  light.bands = {{300, 100}, {300, 100}};
  const ForestIndex index(forest);
  SppOptions options;
  options.variant = variant;
  LightMap map;
  for (auto _ : state) map = spp_light_map(forest, optics, light, options, {});
  require(find_violation(map, index).empty(), "the light map breaks an invariant");
  for (const StageTime& stage : map.provenance.times)
    state.counters[stage.stage + "_ms"] = 1e3 * stage.wall_s;
  for (const auto& [name, value] : map.provenance.settings)
    if (name == "cells") state.counters["cells"] = std::stod(value);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(index.element_count()));
}

void crown_40k(benchmark::State& state) {
  const Forest forest = generated_crown({CrownKind::kSphere, 40000, 3.0, 5.0, 1});
  estimate(state, forest, static_cast<SppVariant>(state.range(0)));
}
BENCHMARK(crown_40k)
    ->Arg(0)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void stand_of_trees(benchmark::State& state) {
  estimate(state, stand(static_cast<int>(state.range(0))), SppVariant::kSppG);
}
BENCHMARK(stand_of_trees)
    ->Arg(4)
    ->Arg(8)
    ->Arg(16)
    ->Arg(32)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace sunfleck
