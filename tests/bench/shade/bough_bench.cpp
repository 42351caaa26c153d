// Speed of the closed forms per ray, one thread.
#include <benchmark/benchmark.h>

#include <vector>

#include "lighting/shade/bough_light.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

Bough paper_bough(int cones) { return {{12, 4.25, 0.05, kPi / 8}, 0.9, cones, 3}; }

Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

struct Ray {
  Vec3 origin;
  BoughDirection direction;
};

// Rays through a sphere round the bough's middle that meet it.
std::vector<Ray> rays_at(const BoughVolume& volume, double middle) {
  RandomStream random(1, 0, RandomPurpose::kTestScene);
  std::vector<Ray> rays;
  while (rays.size() < 1024) {
    const Vec3 d = any_direction(random);
    const Vec3 through(random.uniform(-1, 1), random.uniform(-1, 1), middle + random.uniform(-2, 2));
    const Ray ray{through - 30.0 * d, bough_direction(volume, d)};
    if (bough_spans(volume, ray.origin, ray.direction).count > 0) rays.push_back(ray);
  }
  return rays;
}

void opacity(benchmark::State& state) {
  const BoughVolume volume = bough_volume(paper_bough(static_cast<int>(state.range(0))));
  const auto rays = rays_at(volume, 4);
  std::size_t i = 0;
  for (auto _ : state) {
    const Ray& ray = rays[i++ % rays.size()];
    benchmark::DoNotOptimize(bough_depth(volume, ray.origin, ray.direction));
  }
}
BENCHMARK(opacity)->Arg(0)->Arg(10);

void light(benchmark::State& state) {
  const BoughVolume volume = bough_volume(paper_bough(static_cast<int>(state.range(0))));
  const auto rays = rays_at(volume, 4);
  const BoughDirection sun = bough_direction(volume, glm::normalize(Vec3(1, 2, 1)));
  std::size_t i = 0;
  for (auto _ : state) {
    const Ray& ray = rays[i++ % rays.size()];
    benchmark::DoNotOptimize(bough_light(volume, ray.origin, ray.direction, sun));
  }
}
BENCHMARK(light)->Arg(0)->Arg(10);

void event(benchmark::State& state) {
  const BoughVolume volume = bough_volume(paper_bough(static_cast<int>(state.range(0))));
  const auto rays = rays_at(volume, 4);
  const BoughDirection sun = bough_direction(volume, glm::normalize(Vec3(1, 2, 1)));
  RandomStream random(2, 0, RandomPurpose::kTestScene);
  std::size_t i = 0;
  for (auto _ : state) {
    const Ray& ray = rays[i++ % rays.size()];
    const auto hit = bough_event(volume, ray.origin, ray.direction, random.uniform());
    if (hit) benchmark::DoNotOptimize(event_light(volume, ray.direction, *hit, sun));
  }
}
BENCHMARK(event)->Arg(0)->Arg(10);

}  // namespace
}  // namespace sunfleck
