// The steps of [SPP] Table 4 at 13,000 and 52,000 cells: 16 or 64 instances of one prototype, cells of 16^3
// grids, 22 directions, one band. Published (Core2 Quad 2.33 GHz with GTX 295): 13K cells 117 ms
// preprocessing, 25 ms sky change, 3.9 ms sun change; 52K: 533, 100 and 3.9 to 6.7 ms. Ours on the CPU; every
// label has the error against the closed form in double, taken before the clock starts. `cpu_ms` is the time
// of all threads together.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lighting/slab/spp_estimators.h"
#include "lighting/slab/sun_depths.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

Forest stand(int side, bool turned) {
  Forest forest = generated_crown({CrownKind::kSphere, 1000, 2.0, 3.0, 1});
  const Instance first = forest.instances[0];
  forest.instances.clear();
  for (int i = 0; i < side * side; ++i) {
    Instance tree = first;
    tree.position_m += Vec3(4.2 * (i % side), 4.2 * (i / side), 0.0);
    tree.yaw_rad = turned ? static_cast<float>(0.37 * i) : 0.0f;
    forest.instances.push_back(tree);
  }
  return forest;
}

Vec3 sun() { return direction_from_azimuth_zenith(1.0, radians_from_degrees(40.0)); }

// A stand prepared for one variant, in NIR over soil.
struct Scene {
  Forest forest;
  SppPrepared prepared;
  std::vector<CanopyOptics> optics;

  Scene(int side, SppVariant variant, bool turned)
      : forest(stand(side, turned)), prepared(prepare_spp(forest, {variant, 22, 64, 16, {}}, {})) {
    optics = canopy_optics(forest, OpticsTable(forest, {{"NIR"}, {0.2}, {}}))[0];
  }
  ResponseMedium medium() const {
    return {optics, 0.2, prepared.options.variant == SppVariant::kSppH ? &prepared.angles : nullptr};
  }
  SkyResponse response() const {
    return sky_response(forest, prepared.grids, prepared.cells, medium(), prepared.compensation, {});
  }
  std::vector<double> sources(SkyModel sky) const {
    return sky_sources(prepared.cells.directions, sky, forest.terrain.normal());
  }
};

// Worst error of a sky's scattered light in any cell, relative to the mean, against sums of closed forms in
// double.
double sky_error(const Scene& scene, const ScatteredCells& light, const std::vector<double>& sources) {
  const CellDepths& cells = scene.prepared.cells;
  const std::size_t axes = cells.directions.axes();
  double worst = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < scene.forest.instances.size(); ++i)
    for (std::size_t c = scene.prepared.grids.first_cell[i]; c < scene.prepared.grids.first_cell[i + 1];
         ++c) {
      double sum = 0.0;
      for (std::size_t s = 0; s < axes; ++s) {
        SlabLight<double> slab;
        double scale = sources[s];
        if (const CanopyAngles* angles = scene.medium().angles) {
          const double cosine = cells.directions.upward(s).z;
          slab = spp_h(cells.depths(s)[c], cells.depths(axes + s)[c],
                       angles->medium(cosine, scene.optics[0].absorption, scene.optics[0].turn, 0.2));
          scale *= angles->fluence_scale(cosine);
        } else {
          const Instance& instance = scene.forest.instances[i];
          slab = spp<double>(cells.depths(s)[c], cells.depths(axes + s)[c],
                             scene.optics[0].medium(cells.turn_ratio_of(0, s, instance.yaw_rad), 0.2));
          if (!scene.prepared.compensation.empty()) scale *= scene.prepared.compensation[s * cells.cells + c];
        }
        sum += scale * (slab.down + slab.up);
      }
      mean += sum / static_cast<double>(cells.cells);
      worst = std::max(worst, std::abs(sum - light.sum[c]));
    }
  return worst / mean;
}

// The same for sunlight; `compensation` may be empty.
double sun_error(const Scene& scene, const ScatteredCells& light, const CellSun& sun_cells,
                 const std::vector<float>& compensation) {
  double worst = 0.0, mean = 0.0;
  for (std::size_t c = 0; c < light.sum.size(); ++c) {
    SlabLight<double> slab;
    double scale = compensation.empty() ? 1.0 : compensation[c];
    if (const CanopyAngles* angles = scene.medium().angles) {
      slab = spp_h(sun_cells.before[c], sun_cells.behind[c],
                   angles->medium(sun().z, scene.optics[0].absorption, scene.optics[0].turn, 0.2));
      scale *= angles->fluence_scale(sun().z);
    } else {
      const double turn = sun_cells.turn_ratio[scene.prepared.grids.instance_of(c)];
      slab = spp<double>(sun_cells.before[c], sun_cells.behind[c], scene.optics[0].medium(turn, 0.2));
    }
    mean += scale * (slab.down + slab.up) / static_cast<double>(light.sum.size());
    worst = std::max(worst, std::abs(scale * (slab.down + slab.up) - light.sum[c]));
  }
  return worst / mean;
}

void report(benchmark::State& state, const Scene& scene, double error, const char* published) {
  if (!(error < 1e-4)) throw std::runtime_error("the fast form is off by more than 1e-4 of the mean");
  state.counters["cells"] = static_cast<double>(scene.prepared.cells.cells);
  state.counters["error"] = error;
  state.SetLabel(published);
}

bool large(const benchmark::State& state) { return state.range(0) == 8; }

void preprocessing(benchmark::State& state) {
  const auto variant = static_cast<SppVariant>(state.range(1));
  const Scene scene(static_cast<int>(state.range(0)), variant, true);
  const std::vector<double> sources = scene.sources(SkyModel::kUniform);
  report(state, scene, sky_error(scene, scattered_sky_light(scene.response(), sources, {}), sources),
         large(state) ? "published 533 ms" : "published 117 ms");
  for (auto _ : state) benchmark::DoNotOptimize(prepare_spp(scene.forest, scene.prepared.options, {}));
}

// Another sky over the same leaves.
void sky_change(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)), static_cast<SppVariant>(state.range(1)), true);
  const SkyResponse response = scene.response();
  const std::vector<double> sources = scene.sources(SkyModel::kStandardOvercast);
  report(state, scene, sky_error(scene, scattered_sky_light(response, sources, {}), sources),
         large(state) ? "published 100 ms" : "published 25 ms");
  for (auto _ : state) benchmark::DoNotOptimize(scattered_sky_light(response, sources, {}));
}

// Another sky in a band, or for leaves, that was not asked before: all closed forms anew.
void sky_change_new_band(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)), static_cast<SppVariant>(state.range(1)), true);
  const std::vector<double> sources = scene.sources(SkyModel::kStandardOvercast);
  const auto run = [&] {
    return scattered_sky_light(scene.forest, scene.prepared.grids, scene.prepared.cells, scene.medium(),
                               scene.prepared.compensation, sources, {});
  };
  report(state, scene, sky_error(scene, run(), sources),
         large(state) ? "published 100 ms" : "published 25 ms");
  for (auto _ : state) benchmark::DoNotOptimize(run());
}

// Maps towards the sun, sums over neighbours, G, closed form in every cell. Third argument: 1 if every
// instance has a yaw of its own and so a map of its own; [SPP] only moves its instances.
void sun_change(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)), static_cast<SppVariant>(state.range(1)),
                    state.range(2) == 1);
  CellSun cells;
  std::vector<float> compensation;
  const auto run = [&] {
    cells = measure_cell_sun(scene.forest, scene.prepared.grids, sun(), 64, {});
    if (scene.prepared.options.variant == SppVariant::kSppG)
      compensation = sun_compensation(scene.prepared.cells, cells, sun(), {});
    return scattered_sunlight(scene.forest, scene.prepared.grids, cells, scene.medium(), sun(), compensation,
                              {});
  };
  const ScatteredCells light = run();
  report(state, scene, sun_error(scene, light, cells, compensation), "published 3.9 to 6.7 ms");
  for (auto _ : state) benchmark::DoNotOptimize(run());
}

// Extra, by leaf and not by cell: depths of every leaf towards the sun.
void sun_depths_of_leaves(benchmark::State& state) {
  const Forest forest = stand(static_cast<int>(state.range(0)), true);
  const ForestIndex index(forest);
  for (auto _ : state) benchmark::DoNotOptimize(measure_sun_depths(forest, index, sun(), 64, {}));
  state.counters["leaves"] = static_cast<double>(index.element_count());
}

constexpr int kSpp = static_cast<int>(SppVariant::kSpp), kSppG = static_cast<int>(SppVariant::kSppG),
              kSppH = static_cast<int>(SppVariant::kSppH);
void each_variant(benchmark::internal::Benchmark* b) {
  for (const int side : {4, 8})
    for (const int variant : {kSpp, kSppG, kSppH}) b->Args({side, variant});
  b->ArgNames({"side", "variant"})->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
void each_sun(benchmark::internal::Benchmark* b) {
  for (const int side : {4, 8})
    for (const int turned : {0, 1})
      for (const int variant : {kSpp, kSppG, kSppH}) b->Args({side, variant, turned});
  b->ArgNames({"side", "variant", "turned"})
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}
BENCHMARK(preprocessing)->Apply(each_variant);
BENCHMARK(sky_change)->Apply(each_variant);
BENCHMARK(sky_change_new_band)->Apply(each_variant);
BENCHMARK(sun_change)->Apply(each_sun);
BENCHMARK(sun_depths_of_leaves)
    ->Arg(4)
    ->Arg(8)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace sunfleck
