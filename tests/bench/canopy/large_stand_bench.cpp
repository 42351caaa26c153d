// A large stand: canopy_large_stand [hectares] [trees] [prototypes] [leaves per prototype] [voxel m]. Time,
// memory, and on up to 4 hectares the rays' answer beside it.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "lighting/canopy/large_stand.h"
#include "lighting/canopy/large_stand_check.h"
#include "lighting/canopy/stand_light.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/forest_spec.h"
#include "sim/plant/make_prototype.h"
#include "tests/bench/canopy/season.h"

namespace sunfleck::bench {
namespace {

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Lap {
 public:
  void print(const char* what) {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    const double cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    std::printf("  %-16s wall %7.2f s  cpu %7.2f s  peak %.2f GB\n", what, wall_s() - wall_, cpu - cpu_,
                static_cast<double>(use.ru_maxrss) / 1048576.0);
    std::fflush(stdout);
    wall_ = wall_s();
    cpu_ = cpu;
  }

 private:
  double wall_ = wall_s(), cpu_ = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
};

// Beech and spruce crowns of many sizes, placed at random with a gap in the middle.
Forest large_stand(double side_m, int trees, int prototypes, int leaves) {
  const auto species = SpeciesLibrary::load(std::filesystem::path(SUNFLECK_SOURCE_DIR) / "configs/species");
  const Species& beech = species.find("Fagus sylvatica", "bench");
  const Species& spruce = species.find("Picea abies", "bench");
  Forest forest;
  forest.period = Period{{0, 0}, {side_m, side_m}};
  forest.materials = {beech.material, spruce.material};
  for (int p = 0; p < prototypes; ++p) {
    const Species& s = p % 2 ? spruce : beech;
    const double dbh_cm = 15.0 + 40.0 * p / prototypes;
    CrownShape crown;
    crown.height_m = s.height_m(dbh_cm);
    crown.base_m = s.crown_base_m(dbh_cm);
    crown.widest_m = crown.base_m + (crown.height_m - crown.base_m) / 3.0;
    crown.radius_nesw_m.fill(s.crown_radius_m(dbh_cm));
    crown.dbh_m = 0.01 * dbh_cm;
    forest.prototypes.push_back(
        crown_prototype(s, crown, {s.leaf_area_m2(dbh_cm), leaves, static_cast<std::uint64_t>(p)}));
  }
  RandomStream random(7, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < trees; ++i) {
    Instance tree;
    do {
      tree.position_m = {random.uniform(0, side_m), random.uniform(0, side_m), 0};
    } while (glm::length(Vec2(tree.position_m) - 0.5 * side_m) < 15.0);
    tree.prototype.value = random.below(static_cast<std::uint32_t>(prototypes));
    tree.yaw_rad = static_cast<float>(random.uniform(0, 2 * kPi));
    tree.scale = static_cast<float>(random.uniform(0.85, 1.15));
    tree.tree.value = static_cast<std::uint32_t>(i);
    forest.instances.push_back(tree);
  }
  return forest;
}

// RMS and 95th percentile of ours / theirs - 1 where theirs is more than a tenth of its mean.
void compare(const char* what, const IntervalTable& ours, const IntervalTable& theirs) {
  double mean = 0, mean_ours = 0, noise = 0;
  const std::size_t n = theirs.targets;
  for (std::size_t t = 0; t < n; ++t) {
    mean += theirs.at(0, t) / static_cast<double>(n);
    mean_ours += ours.at(0, t) / static_cast<double>(n);
    noise += std::pow(theirs.error_at(0, t), 2) / static_cast<double>(n);
  }
  std::vector<double> off;
  double squares = 0;
  for (std::size_t t = 0; t < n; ++t) {
    squares += std::pow(ours.at(0, t) - theirs.at(0, t), 2) / static_cast<double>(n);
    if (theirs.at(0, t) > 0.1 * mean) off.push_back(std::abs(ours.at(0, t) / theirs.at(0, t) - 1.0));
  }
  std::sort(off.begin(), off.end());
  std::printf(
      "  %s: mean %.5g, rays %.5g (%+.2f %%); RMS %.2f %% of the mean (rays' noise %.2f %%); relative "
      "median %.2f %%, 95th %.2f %%\n",
      what, mean_ours, mean, 100 * (mean_ours / mean - 1), 100 * std::sqrt(squares) / mean,
      100 * std::sqrt(noise) / mean, 100 * off[off.size() / 2],
      100 * off[static_cast<std::size_t>(0.95 * static_cast<double>(off.size() - 1))]);
}

void run(double hectares, int trees, int prototypes, int leaves, double voxel_m) {
  Lap lap;
  const Forest forest = large_stand(100.0 * std::sqrt(hectares), trees, prototypes, leaves);
  lap.print("grow");
  SeasonOptions season;
  season.by_month = false;
  season.bin_deg = 10;
  season.sky_rings = 6;
  const std::filesystem::path root = std::filesystem::path(SUNFLECK_SOURCE_DIR) / "../shared/data";
  const std::filesystem::path given =
      std::getenv("SUNFLECK_SHARED_DATA") ? std::getenv("SUNFLECK_SHARED_DATA") : "";
  const StandSky sky =
      season_sky((given.empty() ? root : given) / "stands/cloture20/monthly_radiation.csv", season);
  std::printf("  %zu sun bins, %zu sky patches\n", sky.sun.size(), sky.sky.size());
  lap.print("season");
  LargeStandOptions options;
  options.voxel_m = voxel_m;
  options.boxes_per_cell = std::max(1, static_cast<int>(std::lround(2.0 / voxel_m)));
  options.directions_at_once = 2;
  const LargeStandPrepared prepared = prepare_large_stand(forest, options, {});
  std::printf("  boxes %zu (%.0f MB), entries %zu\n", prepared.canopy.voxel_count(),
              4e-6 * static_cast<double>(prepared.canopy.voxel_count()), prepared.canopy.entries.size());
  lap.print("prepare");
  const LargeStandLight light = large_stand_light(forest, prepared, sky, {});
  lap.print("sweeps");
  std::printf("  incident %.6g = trees %.6g + ground %.6g (residual %.2g)\n", light.incident[0],
              light.trees[0], light.ground[0],
              (light.incident[0] - light.trees[0] - light.ground[0]) / light.incident[0]);
  const LargeStandCheck check = check_large_stand(forest, prepared, sky, light, {}, {});
  std::printf("  checked by rays: ground %+.4f of open light, %.4f each; trees %+.2f %%, %.2f %% each\n",
              check.ground_bias, check.ground_error, 100 * check.tree_bias, 100 * check.tree_error);
  lap.print("check");
  if (hectares > 4) return;
  StandSceneOptions fine;
  fine.ground_cell_m = 2;
  const StandScene scene(forest, fine);
  StandLightRequest request;
  request.sky = sky;
  request.rays_per_cell = 500;
  request.scattering = false;
  const StandLight rays = stand_light(scene, OpticsTable(forest, {{"PAR"}, {0.1}, {}}), request, {});
  lap.print("rays");
  compare("trees", light.tree_intercepted, rays.trees.intercepted);
  compare("alone", light.tree_potential, rays.trees.potential);
  compare("ground", light.ground_total, rays.ground.total);
}

}  // namespace
}  // namespace sunfleck::bench

int main(int argc, char** argv) {
  const auto at = [&](int i, double otherwise) { return argc > i ? std::stod(argv[i]) : otherwise; };
  sunfleck::with_threads(0, [&] {
    sunfleck::bench::run(at(1, 1), static_cast<int>(at(2, 500)), static_cast<int>(at(3, 40)),
                         static_cast<int>(at(4, 2000)), at(5, 1.0));
  });
}
