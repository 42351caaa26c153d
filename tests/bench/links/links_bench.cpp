// Time of the links method: tracing the links, direct sun, and a further band on links that are there. Before
// anything is timed the furnace must be even and the links must agree with the traced reference.
#include <benchmark/benchmark.h>

#include <cmath>

#include "lighting/links/links_estimator.h"
#include "lighting/trace/reference.h"
#include "lighting/trace/sun_raster.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

Forest crown(int leaves) { return generated_crown({.kind = CrownKind::kClumped, .leaves = leaves}); }

Illumination sun_and_sky() {
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  light.bands = {{500, 100}};
  return light;
}

OpticsTable near_infrared(const Forest& forest) {
  return OpticsTable(forest, {.bands = {"NIR"}, .soil_albedo = {0.25}, .overrides = {}});
}

bool furnace_is_even() {
  Forest forest = crown(1000);
  forest.materials[0].bands = {{"NIR", 0.5, 0.5, 1}};
  Illumination light;
  light.bands = {{0, 1}};
  const OpticsTable optics(forest, {.bands = {"NIR"}, .soil_albedo = {1.0}, .overrides = {}});
  const LightMap map = links_light_map(forest, optics, light, {.convergence = 1e-6}, {});
  for (const ElementLight& e : map.bands[0].elements)
    if (std::abs(e.front.total() - 1) > 1e-3 || std::abs(e.back.total() - 1) > 1e-3) return false;
  return true;
}

// Means within 2 %: both are noisy by a few tenths of a percent.
bool agrees_with_reference() {
  const Forest forest = crown(1000);
  const OpticsTable optics = near_infrared(forest);
  const LightMap links = links_light_map(forest, optics, sun_and_sky(), {}, {});
  const LightMap truth = reference_light_map(forest, optics, sun_and_sky(), {}, {});
  return std::abs(links.bands[0].mean_irradiance_w_m2 / truth.bands[0].mean_irradiance_w_m2 - 1) < 0.02;
}

bool right() {
  static const bool is_right = furnace_is_even() && agrees_with_reference();
  return is_right;
}

void prepare(benchmark::State& state) {
  if (!right()) return state.SkipWithError("wrong answer");
  const Forest forest = crown(static_cast<int>(state.range(0)));
  const LinksOptions options{.links_per_face = static_cast<int>(state.range(1))};
  std::uint64_t bytes = 0;
  for (auto _ : state) with_threads(1, [&] { bytes = prepare_links(forest, options, {}).table.bytes(); });
  state.counters["bytes_per_face"] = static_cast<double>(bytes) / (2.0 * static_cast<double>(state.range(0)));
}

void further_band(benchmark::State& state) {
  if (!right()) return state.SkipWithError("wrong answer");
  const Forest forest = crown(static_cast<int>(state.range(0)));
  const LinksOptions options{.links_per_face = static_cast<int>(state.range(1))};
  const LinksPrepared prepared = prepare_links(forest, options, {});
  const OpticsTable optics = near_infrared(forest);
  const links::DirectLight direct = links_direct_light(prepared, sun_and_sky(), options, {});
  for (auto _ : state)
    with_threads(1, [&] {
      benchmark::DoNotOptimize(links_light_map(forest, optics, sun_and_sky(), options, prepared, direct, {}));
    });
}

void direct_sun(benchmark::State& state) {
  if (!right()) return state.SkipWithError("wrong answer");
  const Forest forest = crown(static_cast<int>(state.range(0)));
  const LinksPrepared prepared = prepare_links(forest, {.links_per_face = 16}, {});
  const LinksOptions options{.sun_rays_per_element = static_cast<int>(state.range(1))};
  for (auto _ : state)
    with_threads(1,
                 [&] { benchmark::DoNotOptimize(links_direct_light(prepared, sun_and_sky(), options, {})); });
}

links::DirectLight drawn_light(const LinksPrepared& prepared, const LinksOptions& options) {
  const trace::Receivers& r = *prepared.receivers;
  const Illumination light = sun_and_sky();
  const SunExposure sun = raster_sun(r.forest(), r.index(), light.to_sun, light.sun_half_angle_rad,
                                     {.ground = options.ground}, {});
  return links_given_light(prepared, light, options, sun.sunlit_fraction, {});
}

// All that a further sun takes: drawing it, shadow rays for wood and ground, all bounces of one band.
void further_sun(benchmark::State& state) {
  if (!right()) return state.SkipWithError("wrong answer");
  const Forest forest = crown(static_cast<int>(state.range(0)));
  const LinksOptions options{.links_per_face = static_cast<int>(state.range(1))};
  const LinksPrepared prepared = prepare_links(forest, options, {});
  const OpticsTable optics = near_infrared(forest);
  for (auto _ : state)
    with_threads(1, [&] {
      const links::DirectLight direct = drawn_light(prepared, options);
      benchmark::DoNotOptimize(links_light_map(forest, optics, sun_and_sky(), options, prepared, direct, {}));
    });
}

void drawn_sun(benchmark::State& state) {
  if (!right()) return state.SkipWithError("wrong answer");
  const Forest forest = crown(static_cast<int>(state.range(0)));
  const LinksOptions options{.links_per_face = 16};
  const LinksPrepared prepared = prepare_links(forest, options, {});
  for (auto _ : state) with_threads(1, [&] { benchmark::DoNotOptimize(drawn_light(prepared, options)); });
}

BENCHMARK(further_sun)->Args({40000, 16})->Args({40000, 64})->Unit(benchmark::kMillisecond);
BENCHMARK(drawn_sun)->Args({40000})->Unit(benchmark::kMillisecond);
BENCHMARK(prepare)->Args({40000, 16})->Args({40000, 64})->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(further_band)
    ->Args({10000, 64})
    ->Args({40000, 16})
    ->Args({40000, 64})
    ->Args({100000, 64})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(direct_sun)->Args({40000, 8})->Args({40000, 16})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunfleck
