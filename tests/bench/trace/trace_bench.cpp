// Speed of rays and of the whole reference on a sphere crown of random leaves (leaf area index 5 over its
// shadow): rays per second, coherent and incoherent, on one thread.
#include <benchmark/benchmark.h>

#include <cmath>

#include "lighting/trace/ray_scene.h"
#include "lighting/trace/reference.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

Forest crown(std::size_t leaves) {
  RandomStream random(1, 0, RandomPurpose::kTestScene);
  const double side = std::sqrt(5.0 * kPi / static_cast<double>(leaves));
  Forest forest;
  forest.materials = {{"leaf", {{"PAR", 0.1, 0.05, 0.1}, {"NIR", 0.45, 0.45, 0.3}}}};
  Prototype tree;
  tree.materials = {"leaf"};
  while (tree.foliage.size() < leaves) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (glm::dot(p, p) > 1.0) continue;
    const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
    const Basis basis = basis_around({r * std::cos(turn), r * std::sin(turn), z});
    FoliageElement e;
    e.centre_m = p + Vec3(0, 0, 1.5);
    e.half_u_m = 0.5 * side * basis.tangent;
    e.half_v_m = 0.5 * side * basis.bitangent;
    e.area_m2 = static_cast<float>(element_geometric_area(e));
    tree.foliage.push_back(e);
  }
  forest.prototypes.push_back(std::move(tree));
  forest.instances.push_back({});
  return forest;
}

Vec3 point_in_crown(RandomStream& random) {
  return {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(1.0, 2.0)};
}

Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// Each ray from another place in another direction.
void closest_hit_incoherent(benchmark::State& state) {
  const Forest forest = crown(static_cast<std::size_t>(state.range(0)));
  const RayScene scene(forest, {});
  RandomStream random(2, 0, RandomPurpose::kTestScene);
  for (auto _ : state)
    benchmark::DoNotOptimize(scene.closest_hit(point_in_crown(random), any_direction(random)));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(closest_hit_incoherent)->Arg(1500)->Arg(40000)->Arg(100000);

// 256 rays from about one place: the pattern of the reference.
void closest_hit_from_leaves(benchmark::State& state) {
  const Forest forest = crown(static_cast<std::size_t>(state.range(0)));
  const RayScene scene(forest, {});
  RandomStream random(2, 0, RandomPurpose::kTestScene);
  for (auto _ : state) {
    const Vec3 p = point_in_crown(random);
    for (int k = 0; k < 256; ++k) benchmark::DoNotOptimize(scene.closest_hit(p, any_direction(random)));
  }
  state.SetItemsProcessed(256 * state.iterations());
}
BENCHMARK(closest_hit_from_leaves)->Arg(1500)->Arg(40000)->Arg(100000);

// Shadow rays towards one sun.
void occluded_coherent(benchmark::State& state) {
  const Forest forest = crown(static_cast<std::size_t>(state.range(0)));
  const RayScene scene(forest, {});
  RandomStream random(2, 0, RandomPurpose::kTestScene);
  const Vec3 to_sun = glm::normalize(Vec3(1, 1, 2));
  for (auto _ : state) {
    const Vec3 p = point_in_crown(random);
    for (int k = 0; k < 64; ++k) benchmark::DoNotOptimize(scene.occluded(p + Vec3(0.0002 * k, 0, 0), to_sun));
  }
  state.SetItemsProcessed(64 * state.iterations());
}
BENCHMARK(occluded_coherent)->Arg(1500)->Arg(40000)->Arg(100000);

// Everything for two bands on one thread; refuses to time an answer whose energy does not close.
void reference_map(benchmark::State& state) {
  const Forest forest = crown(static_cast<std::size_t>(state.range(0)));
  const OpticsTable optics(forest, {.bands = {"PAR", "NIR"}, .soil_albedo = {0.1, 0.2}, .overrides = {}});
  Illumination light;
  light.to_sun = glm::normalize(Vec3(1, 1, 2));
  light.bands = {{400, 100}, {400, 100}};
  ReferenceOptions options;
  options.rays_per_face = static_cast<int>(state.range(1));
  with_threads(1, [&] {
    for (auto _ : state) {
      const LightMap map = reference_light_map(forest, optics, light, options, {});
      for (const BandLightMap& band : map.bands) {
        const EnergyBudget& b = band.budget;
        if (std::abs(b.residual_w) > 5.0 * b.residual_standard_error_w + 1e-4 * b.incident_w)
          state.SkipWithError("energy does not close");
      }
      for (const StageTime& t : map.provenance.times) state.counters[t.stage + "_s"] = t.cpu_s;
    }
  });
}
BENCHMARK(reference_map)->Args({40000, 64})->Args({40000, 256})->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace sunfleck
