// Time of the world grid: thousands of instances of a few prototypes, sky, sun and all bounces, then single
// trees. Before anything is timed the energy of a periodic stand must close.
//   world_bench [instances] [leaves per prototype] [cell_m] [directions] [threads] [GiB]
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iostream>

#include "lighting/transport/world_light.h"
#include "lighting/transport/world_scene.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// 400 trees per hectare on a jittered lattice, four prototypes of 2.5 m crown radius, any yaw, 0.8 to 1.2 of
// their size.
Forest stand(int instances, int leaves) {
  Forest forest;
  for (const auto& [kind, seed] : {std::pair{CrownKind::kSphere, 1}, std::pair{CrownKind::kClumped, 2},
                                   std::pair{CrownKind::kCone, 3}, std::pair{CrownKind::kShell, 4}}) {
    Forest one = generated_crown({.kind = kind,
                                  .leaves = leaves,
                                  .radius_m = 2.5,
                                  .crown_lai = 4,
                                  .seed = static_cast<std::uint64_t>(seed)});
    forest.materials = one.materials;
    forest.prototypes.push_back(std::move(one.prototypes[0]));
  }
  const int side = static_cast<int>(std::ceil(std::sqrt(instances)));
  RandomStream random(11, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < instances; ++i) {
    Instance instance;
    instance.position_m = {5.0 * (i % side) + random.uniform(0, 2), 5.0 * (i / side) + random.uniform(0, 2),
                           0.0};
    instance.prototype = {static_cast<std::uint32_t>(i % 4)};
    instance.yaw_rad = static_cast<float>(random.uniform(0, 6.28));
    instance.scale = static_cast<float>(random.uniform(0.8, 1.2));
    forest.instances.push_back(instance);
  }
  return forest;
}

int run(int argc, char** argv) {
  const auto number = [&](int i, double usual) { return argc > i ? std::atof(argv[i]) : usual; };
  const int instances = static_cast<int>(number(1, 10000)), leaves = static_cast<int>(number(2, 50000));
  WorldOptions options;
  options.cell_m = number(3, 0);
  options.directions = static_cast<int>(number(4, 26));
  options.memory_limit_bytes = static_cast<std::uint64_t>(number(6, 1) * (1 << 30));
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  light.bands = {{900, 100}};

  Forest small = stand(100, 2000);
  small.period = Period{{0, 0}, {50, 50}};
  const auto near_infrared = [](const Forest& forest) {
    return OpticsTable(forest, {.bands = {"NIR"}, .soil_albedo = {0.2}, .overrides = {}});
  };
  const WorldLight check =
      world_light(small, near_infrared(small), light, {}, prepare_world(small, {}, {}), {});
  const EnergyBudget& budget = check.bands[0].budget;
  if (!(std::abs(budget.residual_w) < 0.03 * budget.incident_w)) {
    std::cerr << "the energy of a periodic stand does not close\n";
    return 1;
  }

  const Forest forest = stand(instances, leaves);
  const OpticsTable optics = near_infrared(forest);
  with_threads(static_cast<int>(number(5, 2)), [&] {
    double start = seconds();
    const WorldPrepared prepared = prepare_world(forest, options, {});
    std::cout << "prepare_s " << seconds() - start;
    for (const StageTime& t : prepared.times)
      std::cout << " | " << t.stage << ' ' << t.wall_s << " cpu " << t.cpu_s;
    std::cout << "\ncell_m " << prepared.scene->layout.mean_cell_m() << " cells " << prepared.scene->cells()
              << " entries " << prepared.scene->entries.size() << '\n';
    start = seconds();
    const WorldLight world = world_light(forest, optics, light, options, prepared, {});
    std::cout << "world_light_s " << seconds() - start << " iterations " << world.bands[0].iterations;
    for (const StageTime& t : world.times)
      std::cout << " | " << t.stage << ' ' << t.wall_s << " cpu " << t.cpu_s;
    std::cout << '\n';
    double wall = 0.0, slowest = 0.0, cpu = 0.0, least_cpu = 1e9;
    constexpr int kTrees = 60;
    std::string settings;
    for (int k = 0; k < kTrees; ++k) {
      const std::size_t tree = (static_cast<std::size_t>(instances) / 2 + static_cast<std::size_t>(k) * 7) %
                               static_cast<std::size_t>(instances);
      const double cpu_start = cpu_seconds();
      start = seconds();
      const LightMap map = tree_light(forest, optics, world, tree, options, {});
      const double took = seconds() - start;
      wall += took / kTrees;
      cpu += (cpu_seconds() - cpu_start) / kTrees;
      least_cpu = std::min(least_cpu, cpu_seconds() - cpu_start);
      slowest = std::max(slowest, took);
      settings.clear();
      for (const auto& [name, value] : map.provenance.settings) settings += ' ' + name + ' ' + value;
      for (const StageTime& t : map.provenance.times)
        settings += " | " + t.stage + " cpu_ms " + std::to_string(1e3 * t.cpu_s);
    }
    std::cout << "tree_light_s mean " << wall << " slowest " << slowest << " cpu " << cpu << " least "
              << least_cpu << settings << '\n';
  });
  return 0;
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) { return sunfleck::run(argc, argv); }
