// What `auto`'s rungs are worth: of every grid with the sun drawn, on many crowns, the error and the cost
// that auto_rungs.h and auto_cost.h predict beside those found (error by 4,000 probes, corrected by a fit to
// 200 others as in `auto`; CPU time of one core, least of two, probes apart). The constants of the
// predictions were fitted to such tables.
//
//   rungs_bench [scenes [bands [tolerance]]]
//
// scenes: names of named_forest.h, separated by commas.
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "lighting/bench/error_against_time.h"
#include "lighting/bench/stopwatch.h"
#include "lighting/depth/close_cover.h"
#include "lighting/plan/auto_attempt.h"
#include "lighting/plan/auto_direct.h"
#include "lighting/plan/auto_rungs.h"
#include "lighting/plan/kept_grid.h"
#include "lighting/plan/plan.h"
#include "sim/base/parallel.h"
#include "tests/bench/plan/named_forest.h"

namespace sunfleck {
namespace {

constexpr ProbePlan kJudges{.count = 4000, .paths_per_face = 64, .sun_rays = 128, .seed = 424242};
constexpr ProbePlan kOwn{.count = 200, .paths_per_face = 32, .sun_rays = 128, .seed = 1};

struct Found {
  double total = 0, diffuse = 0, direct = 0;  // RMS, in shares of the mean light
};

Found found(const ProbeSet& probes, const LightMap& map, std::size_t band) {
  Found f;
  double mean = 0.0;
  const auto n = static_cast<double>(probes.probes.size());
  for (const ProbeLight& p : probes.probes) {
    const ProbeBand& truth = p.bands[band];
    const LightParts t = parts_of(truth), e = parts_of(map.bands[band].elements[p.element]);
    mean += t.total() / n;
    f.total += (std::pow(e.total() - t.total(), 2) - truth.variance_w2_m4()) / n;
    f.diffuse += (std::pow(e.diffuse() - t.diffuse(), 2) - truth.diffuse_variance_w2_m4) / n;
    f.direct += (std::pow(e.direct_w_m2 - t.direct_w_m2, 2) - truth.direct_variance_w2_m4) / n;
  }
  for (double* x : {&f.total, &f.diffuse, &f.direct}) *x = std::sqrt(std::max(0.0, *x)) / mean;
  return f;
}

void print_spread(const char* what, const LightSpread& s) {
  std::printf("  %s: direct share %.3f, diffuse share %.3f spread %.3f, sun scatter %.3f\n", what,
              s.direct_share, s.diffuse_share, s.diffuse_spread, s.sun_scatter);
}

void table(const Forest& forest, const LightRequest& request, double tolerance) {
  const ForestIndex index(forest);
  const std::string hash = content_hash(forest);
  const Plan plan = make_plan(forest, index, request);
  const OpticsTable optics(forest, request.optics);
  const ProbeScene rays(forest, request.reference.ground, {});
  const ProbeSet judges = draw_probes(rays, optics, plan.light, kJudges, {}),
                 own = draw_probes(rays, optics, plan.light, kOwn, {});
  const std::size_t bands = request.light.bands.size();
  const LightSpread spread = light_spread(judges, bands);
  std::printf("%s: %zu leaves, side %.4f m, tree %.3f m, clumping %.3f, cell of the rule %.4f m\n",
              forest.name.c_str(), index.element_count(), plan.sizes.leaf_side_m, plan.sizes.tree_extent_m,
              plan.sizes.clumping, plan.sizes.grid_cell_m);
  print_spread("4000 probes", spread);
  print_spread(" 200 probes", light_spread(own, bands));
  AutoOptions options;
  options.tolerance = tolerance;
  const Stopwatch close_watch;
  const std::vector<float> close = close_cover(forest, {});
  std::printf("  close cover %.4f s\n", close_watch.cpu_s());
  const Judge judge{forest, index, optics, own, nullptr, options, close};
  for (const Rung& rung : rungs_for_elements(plan.sizes, spread, request, tolerance, true)) {
    if (rung.kind != RungKind::kDrawnGrid) continue;
    double cpu_s = 1e9, sun_s = 1e9;
    LightMap map;
    for (int i = 0; i < 2; ++i) {
      PreparedCache cache(512ull << 20);
      const PreparedStore store{cache, "bench"};
      const LightScene scene{forest, index, hash, store, 1};
      const Stopwatch sun_watch;
      const auto exposure = sun_exposure(
          scene, plan.light,
          {.pixel_m = sun_pixel_sides(spread, rung.sun_error) * plan.sizes.leaf_side_m, .sun_directions = 1},
          {});
      sun_s = std::min(sun_s, sun_watch.cpu_s());
      const Stopwatch watch;
      map = kept_grid_light_map(scene, optics, plan.light, rung.grid, exposure->sunlit_fraction, {});
      cpu_s = std::min(cpu_s, watch.cpu_s());
    }
    const Attempt attempt =
        judge.judge(rung.name(), std::move(map),
                    {CorrectionForm::kDiffuse, CorrectionForm::kDiffuseParts, CorrectionForm::kDiffuseBySun,
                     CorrectionForm::kDiffuseByClose, CorrectionForm::kDiffuseBySunAndClose});
    for (std::size_t b = 0; b < bands; ++b) {
      const Found f = found(judges, attempt.map, b);
      std::printf(
          "  %s %2d directions, %.1f sides: predicted %.4f, found %.4f (own probes %.4f) diffuse %.4f "
          "direct %.4f (aimed %.4f); predicted %.3f s, grid %.3f + sun %.3f s\n",
          attempt.map.bands[b].band.c_str(), rung.grid.directions, rung.grid.cell_m / plan.sizes.leaf_side_m,
          rung.predicted_error, f.total, point_error(attempt.bands[b].sample).element_rms, f.diffuse,
          f.direct, rung.sun_error * spread.direct_share, rung.predicted_s, cpu_s, sun_s);
    }
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace sunfleck

int main(int count, char** words) {
  using namespace sunfleck;
  const auto word = [&](int i, const char* usual) { return std::string(count > i ? words[i] : usual); };
  std::istringstream names(word(1, "sphere,clumped,beech"));
  for (std::string name; std::getline(names, name, ',');) {
    const Forest forest = named_forest(name);
    with_threads(1, [&] { table(forest, bench_light(forest, word(2, "PAR")), std::stod(word(3, "0.10"))); });
  }
  return 0;
}
