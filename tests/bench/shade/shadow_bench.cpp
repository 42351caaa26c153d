// Cost of the sun's shadow at a point of a leaf: shadow ray, cube masks, tile. 40,000 random leaves, crown
// LAI
// 5. CPU time of one thread; the ratio ray / tile is what counts.
#include <benchmark/benchmark.h>

#include "lighting/shade/cube_mask.h"
#include "lighting/shade/shadow_tile.h"
#include "lighting/trace/ray_scene.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.3, -0.4, 1.0));

struct Crown {
  Forest forest = generated_crown({CrownKind::kSphere, 40000, 1, 5, 3});
  MaskLeaves leaves = mask_leaves(forest.prototypes[0], "crown");
  std::vector<Vec3> points;
  std::vector<float> transmittance;
  std::vector<std::uint32_t> leaf;
  Crown() {
    RandomStream random(1, 0, RandomPurpose::kTestScene);
    for (int i = 0; i < 65536; ++i) {
      leaf.push_back(random.below(40000));
      const FoliageElement& e = forest.prototypes[0].foliage[leaf.back()];
      points.push_back(Vec3(e.centre_m) + random.uniform(-1, 1) * Vec3(e.half_u_m) +
                       random.uniform(-1, 1) * Vec3(e.half_v_m));
      transmittance.push_back(static_cast<float>(random.uniform()));
    }
  }
};
const Crown& crown() {
  static const Crown made;
  return made;
}

void shadow_ray(benchmark::State& state) {
  const RayScene scene(crown().forest, {.ground = false});
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ & 65535;
    benchmark::DoNotOptimize(
        scene.occluded(crown().points[k], kSun, 0, {HitKind::kFoliage, true, 0, crown().leaf[k]}));
  }
}
BENCHMARK(shadow_ray);

void shadow_tile(benchmark::State& state) {
  const ShadowTile tile = build_shadow_tile(crown().leaves, {static_cast<int>(state.range(0)), 8, 1});
  const TileView view = view_tile(tile, kSun);
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ & 65535;
    benchmark::DoNotOptimize(tile_lit(view, crown().points[k], crown().transmittance[k]));
  }
}
BENCHMARK(shadow_tile)->Arg(128)->Arg(256)->Arg(512);

void cube_mask(benchmark::State& state) {
  const CubeMask mask =
      build_cube_mask(crown().leaves, {MaskForm::kDistance, static_cast<int>(state.range(0)), 128, 1});
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ & 65535;
    benchmark::DoNotOptimize(cube_lit(mask, {0.005 * kSun, kSun, 0.6, {}, 0}));
    benchmark::DoNotOptimize(k);
  }
}
BENCHMARK(cube_mask)->Arg(1)->Arg(4);

void build_tile(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(build_shadow_tile(crown().leaves, {static_cast<int>(state.range(0)), 8, 1}));
}
BENCHMARK(build_tile)->Arg(128)->Arg(256)->Arg(512)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sunfleck
