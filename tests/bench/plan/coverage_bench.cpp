// How often the 95 % intervals of probes hold the true error, scene by scene, with many seeds; for the probes
// of
// `[light.probes]` by default and for the fewer paths that `auto` takes at a tolerance of 0.10.
//
//   coverage_bench [seeds]
#include <string>

#include "tests/lighting/plan/covered_scene.h"

int main(int count, char** words) {
  using namespace sunfleck;
  using namespace sunfleck::test;
  const int seeds = count > 1 ? std::stoi(words[1]) : 100;
  const auto percent = [](int inside, int of) { return 100.0 * inside / of; };
  const ProbePlan few{.count = 200, .paths_per_face = 32, .sun_rays = 128};
  Coverage usual, fewer;
  int groups_inside = 0, group_bars = 0;
  for (const Forest& forest : scenes_for_error_bars()) {
    const CoveredScene scene(forest);
    const Coverage a = scene.count({}, seeds), b = scene.count(few, seeds);
    const auto [inside, bars] = scene.count_groups(seeds);
    std::printf(
        "%-10s bias %.1f rms %.1f | fewer paths: bias %.1f rms %.1f | trees or layers %.1f %% of %d\n",
        forest.name.c_str(), percent(a.inside_bias, a.bars), percent(a.inside_rms, a.bars),
        percent(b.inside_bias, b.bars), percent(b.inside_rms, b.bars), percent(inside, bars), bars);
    std::fflush(stdout);
    usual.add(a);
    fewer.add(b);
    groups_inside += inside;
    group_bars += bars;
  }
  std::printf(
      "all        bias %.1f rms %.1f | fewer paths: bias %.1f rms %.1f | trees or layers %.1f %% of %d\n",
      percent(usual.inside_bias, usual.bars), percent(usual.inside_rms, usual.bars),
      percent(fewer.inside_bias, fewer.bars), percent(fewer.inside_rms, fewer.bars),
      percent(groups_inside, group_bars), group_bars);
  return 0;
}
