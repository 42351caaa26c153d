// Time of a step of a grid march, of a grid, and of the envelope estimator. Each answer is checked against
// the ball's closed form before it is timed; a wrong one stops the benchmark.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>

#include "lighting/depth/extinction_grid.h"
#include "lighting/envelope/bounce_kernel.h"
#include "lighting/envelope/closed_forms.h"
#include "lighting/envelope/envelope_estimator.h"
#include "lighting/envelope/envelope_full.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.45, 0.25, 0.86));

Forest crown(const benchmark::State& state) {
  return generated_crown({.leaves = static_cast<int>(state.range(0)), .crown_lai = 5});
}

// Mean sunlit share of a ball of LAI 5: (1 - T) / 2.5, T = 0.12633.
bool plausible(double sunlit) { return std::abs(sunlit / 0.34947 - 1) < 0.05; }

// Faces crossed on the straight way to the border from the middle of an average leaf: half the mean chord of
// each axis; counted here by walking without looking at the cells.
double mean_steps(const BlockerField& field, const Vec3& direction) {
  double steps = 0.0;
  for (const FieldElement& e : field.elements()) {
    const Vec3 lo = field.layout().lo_m, hi = lo + field.layout().size_m(), p(e.centre_m);
    double leave = 1e30;
    for (int a = 0; a < 3; ++a)
      if (direction[a] != 0) leave = std::min(leave, ((direction[a] > 0 ? hi : lo)[a] - p[a]) / direction[a]);
    for (int a = 0; a < 3; ++a) steps += leave * std::abs(direction[a]) / field.layout().cell_m[a];
  }
  return steps / static_cast<double>(field.elements().size());
}

void march(benchmark::State& state) {
  const Forest forest = crown(state);
  const BlockerField field(forest, {}, {});
  const ExtinctionGrid grid(field, kSun, {});
  const double steps = mean_steps(field, kSun) * static_cast<double>(field.elements().size());
  double sunlit = 0.0;
  for (const float d : grid.depth_of_elements(March::kForward, {}))
    sunlit += std::exp(-d) / static_cast<double>(field.elements().size());
  if (!plausible(sunlit)) return state.SkipWithError("wrong sunlit share");
  for (auto _ : state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < field.elements().size(); ++i)
      sum += grid.depth_from_element(i, March::kForward);
    benchmark::DoNotOptimize(sum);
  }
  state.counters["per_step"] = benchmark::Counter(steps * static_cast<double>(state.iterations()),
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(march)->Arg(40000)->Unit(benchmark::kMillisecond);

void fill_grid(benchmark::State& state) {
  const Forest forest = crown(state);
  const BlockerField field(forest, {}, {});
  ExtinctionGrid grid(field, kSun, {});
  for (auto _ : state) with_threads(1, [&] { grid.turn_to(kSun, {}); });
}
BENCHMARK(fill_grid)->Arg(40000)->Unit(benchmark::kMillisecond);

void estimator(benchmark::State& state) {
  const Forest forest = crown(state);
  OpticsRequest request;
  request.bands = {"PAR", "NIR"};
  request.soil_albedo = {0.1, 0.2};
  const OpticsTable optics(forest, request);
  Illumination light;
  light.to_sun = kSun;
  light.bands = {{500, 100}, {400, 80}};
  const EnvelopeOptions options{.sun = state.range(1) == 0 ? EnvelopeSun::kPublished : EnvelopeSun::kMarched,
                                .cell_m = 0};
  LightMap map = envelope_light_map(forest, optics, light, options, {});
  const double sunlit = std::accumulate(map.sunlit_fraction.begin(), map.sunlit_fraction.end(), 0.0) /
                        static_cast<double>(map.sunlit_fraction.size());
  if (options.sun == EnvelopeSun::kMarched && !plausible(sunlit))
    return state.SkipWithError("wrong sunlit share");
  for (auto _ : state) with_threads(1, [&] { map = envelope_light_map(forest, optics, light, options, {}); });
  for (const StageTime& stage : map.provenance.times)
    state.counters[stage.stage + "_ms"] = 1e3 * stage.wall_s;
}
BENCHMARK(estimator)
    ->ArgNames({"leaves", "marched"})
    ->ArgsProduct({{1500, 40000, 160000}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

OpticsTable two_bands(const Forest& forest) {
  return OpticsTable(forest, {.bands = {"PAR", "NIR"}, .soil_albedo = {0.1, 0.2}, .overrides = {}});
}

Illumination sun_and_sky() {
  Illumination light;
  light.to_sun = kSun;
  light.bands = {{500, 100}, {400, 80}};
  return light;
}

EnvelopeFullOptions full_options(const benchmark::State& state) {
  EnvelopeFullOptions options;
  options.directions = static_cast<int>(state.range(1));
  return options;
}

// What the forest alone decides.
void full_prepare(benchmark::State& state) {
  const Forest forest = crown(state);
  for (auto _ : state)
    with_threads(1, [&] { benchmark::DoNotOptimize(prepare_envelope(forest, full_options(state), {})); });
}
BENCHMARK(full_prepare)
    ->ArgNames({"leaves", "directions"})
    ->ArgsProduct({{1500, 40000, 160000}, {8, 14, 26}})
    ->Unit(benchmark::kMillisecond);

// Sun, sky, ground and two bands for all leaves.
void full_evaluate(benchmark::State& state) {
  const Forest forest = crown(state);
  const OpticsTable optics = two_bands(forest);
  const EnvelopePrepared prepared = prepare_envelope(forest, full_options(state), {});
  LightMap map = envelope_full_light_map(forest, optics, sun_and_sky(), prepared, {});
  const double sunlit = std::accumulate(map.sunlit_fraction.begin(), map.sunlit_fraction.end(), 0.0) /
                        static_cast<double>(map.sunlit_fraction.size());
  if (!plausible(sunlit)) return state.SkipWithError("wrong sunlit share");
  for (auto _ : state)
    with_threads(1, [&] { map = envelope_full_light_map(forest, optics, sun_and_sky(), prepared, {}); });
  for (const StageTime& stage : map.provenance.times) state.counters[stage.stage + "_ms"] = 1e3 * stage.cpu_s;
  state.counters["memory_MB"] = static_cast<double>(prepared.memory_bytes()) / 1e6;
}
BENCHMARK(full_evaluate)
    ->ArgNames({"leaves", "directions"})
    ->ArgsProduct({{1500, 40000, 160000}, {8, 14, 26, 50}})
    ->Unit(benchmark::kMillisecond);

// One leaf after the other, as a caller with few questions asks.
void full_query(benchmark::State& state) {
  const Forest forest = crown(state);
  const OpticsTable optics = two_bands(forest);
  const EnvelopePrepared prepared = prepare_envelope(forest, full_options(state), {});
  const EnvelopeQuery query(forest, optics, sun_and_sky(), prepared, {});
  const LightMap map = envelope_full_light_map(forest, optics, sun_and_sky(), prepared, {});
  if (query.at_element(77).bands[1].front.total() != map.bands[1].elements[77].front.total())
    return state.SkipWithError("a single answer differs from the map");
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(query.at_element(i));
    i = (i + 7919) % map.sunlit_fraction.size();
  }
}
BENCHMARK(full_query)->ArgNames({"leaves", "directions"})->ArgsProduct({{40000}, {8, 14, 26}});

void bounce_rows(benchmark::State& state) {
  const bool plain = state.range(0) == 0;
  std::vector<float> light(16), approach(16), integral(16), twin(16);
  for (std::size_t k = 0; k < 16; ++k) {
    light[k] = 0.1f * static_cast<float>(k);
    approach[k] = std::cos(static_cast<float>(k));
  }
  envelope::bounce_row(light, approach, 1.0f, integral);
  envelope::bounce_row_plain(light, approach, 1.0f, twin);
  for (std::size_t k = 0; k < 16; ++k)
    if (std::abs(integral[k] - twin[k]) > 4e-6f) return state.SkipWithError("the kernel is not its twin");
  float depth = 0.1f;
  for (auto _ : state) {
    if (plain)
      envelope::bounce_row_plain(light, approach, depth, integral);
    else
      envelope::bounce_row(light, approach, depth, integral);
    depth = depth < 3.0f ? depth + 0.01f : 0.1f;
    benchmark::DoNotOptimize(integral.data());
  }
  state.counters["per_integral"] =
      benchmark::Counter(16.0 * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(bounce_rows)->ArgName("vector")->Arg(0)->Arg(1);

void one_bounce(benchmark::State& state) {
  double depth = 0.1, sum = 0.0;
  for (auto _ : state) {
    sum += envelope::one_bounce_integral(depth, 0.3, 2.0 - depth);
    depth = depth < 1.9 ? depth + 0.01 : 0.1;
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(one_bounce);

}  // namespace
}  // namespace sunfleck
