#include "lighting/plan/auto_method.h"

#include <algorithm>
#include <cmath>

#include "lighting/base/summaries.h"
#include "lighting/plan/auto_report.h"
#include "lighting/plan/auto_run.h"
#include "lighting/plan/auto_time.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// False where it does not fit the memory, which a note says.
bool attempt_if_it_fits(AutoRun& run, const Rung& rung, bool& tolerable, const RunControl& control) {
  try {
    tolerable = run.attempt(rung, control);
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kLimitExceeded) throw;
    run.note(rung.name() + " was not run: " + error.what());
    return false;
  }
}

// Those that cannot do better than one that failed.
void drop(std::vector<Rung>& rungs, const Rung& failed, bool of_elements) {
  std::erase_if(rungs, [&](const Rung& r) {
    if (r.kind != failed.kind) return false;
    return of_elements ? r.predicted_error >= failed.predicted_error
                       : r.grid.cell_m == failed.grid.cell_m && r.grid.directions == failed.grid.directions;
  });
}

LightMap answer_by_tolerance(AutoRun& run, const ProbePlan& plan, const RunControl& control) {
  run.probe(plan, control);
  const double aim = run.options().aim();
  const bool of_elements = run.is_of_elements();
  std::vector<Rung> rungs =
      of_elements ? rungs_for_elements(run.sizes(), run.spread(), run.request(), aim, run.has_sun())
                  : rungs_for_sums(run.sizes(), run.spread(), run.request(), aim, run.has_sun());
  double worse = 1.0, grid_predicted = aim;
  for (;;) {
    const int next = best_rung(rungs, aim, worse);
    if (next < 0 || rungs[static_cast<std::size_t>(next)].kind == RungKind::kReference) break;
    const Rung rung = rungs[static_cast<std::size_t>(next)];
    if (rung.kind == RungKind::kLinks && run.may_look_again()) {
      if (run.look_again(control)) return run.answer();
      worse = std::max(1.0, 1e-9 + run.last_error() / grid_predicted);  // a finer grid may do after all
      continue;
    }
    bool tolerable = false;
    if (attempt_if_it_fits(run, rung, tolerable, control)) {
      if (tolerable) return run.answer();
      if (of_elements && rung.kind == RungKind::kDrawnGrid)
        worse = std::max(worse, 1e-9 + run.last_error() / rung.predicted_error);
      if (rung.kind == RungKind::kDrawnGrid) grid_predicted = rung.predicted_error;
    }
    drop(rungs, rung, of_elements);
  }
  if (run.may_look_again() && run.look_again(control)) return run.answer();
  bool tolerable = false;
  Rung reference;
  reference.kind = RungKind::kReference;
  if (!attempt_if_it_fits(run, reference, tolerable, control) && !run.has_answer())
    run.attempt(smallest_rung(run), control);
  return run.answer();
}

// Few paths to many probes: the noise of a probe is known and taken out, and should be about as large as the
// error asked for; and as many probes as a part of what the cheapest answer costs pays for. Sums need to tell
// small differences.
ProbePlan usual_plan(const AutoOptions& options, const SceneSizes& sizes, std::size_t bands) {
  if (options.measure != AutoMeasure::kElementRms) return {};
  constexpr double kShareOfCost = 0.12, kUsualPixel = 0.1;
  constexpr int kFewest = 200, kMost = 1500;
  GridOptions grid;
  grid.directions = 8;
  grid.cell_m = 8.0 * sizes.leaf_side_m;
  const double affordable_s = kShareOfCost * (grid_s(sizes, grid, bands) + sun_drawing_s(sizes, kUsualPixel));
  ProbePlan plan;
  plan.paths_per_face = static_cast<int>(std::clamp(32.0 * std::pow(0.1 / options.aim(), 2.0), 32.0, 64.0));
  const double more = affordable_s / probes_s(plan, bands, false);
  plan.count = static_cast<int>(std::clamp<double>(plan.count * more, kFewest, kMost));
  return plan;
}

}  // namespace

LightMap auto_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                        const LightRequest& request, const SceneSizes& sizes, const MethodRunner& run,
                        const RunControl& control) {
  check_options(request.automatic);
  if (request.probes) check_options(*request.probes);
  const TimeLeft time(request.automatic.time_s.value_or(0.0));
  AutoRun automatic(scene, optics, light, request, sizes, run);
  const ProbePlan plan = request.probes.value_or(usual_plan(request.automatic, sizes, optics.band_count()));
  return request.automatic.time_s ? answer_in_time(automatic, plan, time, control)
                                  : answer_by_tolerance(automatic, plan, control);
}

void add_error_bars(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                    const ProbePlan& plan, bool ground, LightMap& map, const RunControl& control) {
  const StageTimer timer(map.provenance, "probing");
  const ProbeScene rays(trace::KeptRays(scene.forest, scene.store, control), ground);
  const ProbeSet probes = draw_probes(rays, optics, light, plan, control);
  const Resamples resamples(probes.probes.size(), plan.seed);
  add_probe_settings(plan, map.provenance);
  for (std::size_t b = 0; b < map.bands.size(); ++b)
    add_error_bar(sample_error(probes, map.bands[b], b), resamples, map.bands[b], map.provenance);
}

}  // namespace sunfleck
