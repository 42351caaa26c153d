// How the grid method's cost grows with leaves and with instances: CPU time on one thread, best of a few
// runs, and the exponent from one size to the next.
//   grid_growth [most leaves]
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <iostream>

#include "lighting/transport/grid_estimator.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void measure(const char* what, double size, const Forest& forest, double& last_size, double& last_time) {
  const OpticsTable optics(forest, {.bands = {"NIR"}, .soil_albedo = {0.2}, .overrides = {}});
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  light.bands = {{900, 100}};
  double best = 1e9;
  LightMap map;
  const int runs = ForestIndex(forest).element_count() > 300000 ? 2 : 4;
  for (int run = 0; run < runs; ++run) {
    const double start = cpu_seconds();
    with_threads(1, [&] { map = grid_light_map(forest, optics, light, {}, {}); });
    best = std::min(best, cpu_seconds() - start);
  }
  std::cout << what << ' ' << size << " cpu_s " << best;
  for (const StageTime& t : map.provenance.times) std::cout << " | " << t.stage << ' ' << t.cpu_s;
  for (const auto& [name, value] : map.provenance.settings)
    if (name == "cells" || name == "iterations") std::cout << ' ' << name << ' ' << value;
  if (last_size > 0.0) std::cout << " exponent " << std::log(best / last_time) / std::log(size / last_size);
  std::cout << '\n';
  last_size = size;
  last_time = best;
}

int run(int argc, char** argv) {
  const double most = argc > 1 ? std::atof(argv[1]) : 1e6;
  double size = 0.0, time = 0.0;
  for (double leaves = 1e3; leaves <= most * 1.01; leaves *= std::sqrt(10.0))
    measure("leaves", std::round(leaves),
            generated_crown({.leaves = static_cast<int>(leaves), .crown_lai = 5}), size, time);
  size = 0.0;
  const Forest one = generated_crown({.leaves = 1000, .crown_lai = 4});
  for (int side = 1; 1000.0 * side * side <= most * 1.1; side *= 2) {
    Forest stand = one;
    stand.instances.clear();
    for (int i = 0; i < side * side; ++i)
      stand.instances.push_back({.position_m = {2.5 * (i % side), 2.5 * (i / side), 0},
                                 .prototype = {},
                                 .yaw_rad = 0.1f * static_cast<float>(i),
                                 .scale = 1.0f,
                                 .tree = {}});
    measure("instances", side * side, stand, size, time);
  }
  return 0;
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) { return sunfleck::run(argc, argv); }
