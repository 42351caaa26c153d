#include "lighting/plan/auto_method.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "lighting/base/summaries.h"
#include "lighting/plan/auto_attempt.h"
#include "lighting/plan/auto_cost.h"
#include "lighting/plan/auto_direct.h"
#include "lighting/plan/auto_report.h"
#include "lighting/trace/probe_path.h"
#include "lighting/transport/grid_limits.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

using Clock = std::chrono::steady_clock;

// Share of the tolerance that drawing the sun may use up: finer costs more than the rest can win back.
constexpr double kSunShare = 0.35;
// For sums, where errors of single elements average out.
constexpr double kSunErrorOfSums = 0.2;

class Ladder {
 public:
  Ladder(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
         const LightRequest& request, const MethodRunner& run, const RunControl& control)
      : scene_(scene),
        optics_(optics),
        light_(light),
        request_(request),
        options_(request.automatic),
        plan_(request.probes.value_or(ProbePlan{})),
        run_(run),
        control_(control),
        sizes_(scene_sizes(scene.forest)) {}

  LightMap climb() {
    if (options_.time_s) return best_in_time();
    probe();
    for (const GridOptions& grid : fitting_rungs(options_.aim()))
      if (try_grid(grid)) return finish();
    try_reference();
    return finish();
  }

 private:
  void probe() {
    {
      const StageTimer timer(times_, "building ray scene");
      rays_ = std::make_unique<ProbeScene>(trace::KeptRays(scene_.forest, scene_.store, control_),
                                           request_.reference.ground);
    }
    const StageTimer timer(times_, "probing");
    probes_ = draw_probes(*rays_, optics_, light_, plan_, control_);
    if (is_of_groups(options_.measure))
      groups_ = draw_group_probes(*rays_, optics_, light_, plan_, options_, control_);
  }

  // A rung whose cells do not fit the memory takes the cells that do; nobody asked for its size.
  std::vector<GridOptions> fitting_rungs(double tolerance) const {
    std::vector<GridOptions> rungs = grid_rungs(sizes_, request_.grid, tolerance);
    for (GridOptions& grid : rungs)
      if (request_.grid.cell_m == 0.0 && !grid_suitability(scene_.forest, grid).fits) grid.cell_m = 0.0;
    return rungs;
  }

  // As it is, then with the sun drawn over it.
  bool try_grid(const GridOptions& grid) {
    LightMap map = run_grid(grid);
    const bool sun = trace::has_beam(light_);
    if (take(judge().judge(name_of(grid), sun ? map : std::move(map),
                           {CorrectionForm::kTotal, CorrectionForm::kParts})))
      return true;
    return sun && take_with_sun(grid, std::move(map), sun_error_for_tolerance());
  }

  bool take_with_sun(const GridOptions& grid, LightMap map, double sun_error) {
    draw_sun(sun_error, map);
    return take(judge().judge(
        name_of(grid) + " with drawn sun", std::move(map),
        {CorrectionForm::kDiffuse, CorrectionForm::kDiffuseParts, CorrectionForm::kDiffuseBySun}));
  }

  LightMap run_grid(const GridOptions& grid) {
    LightRequest asked = request_;
    asked.method = Method::kGrid;
    asked.grid = grid;
    return run_timed(asked);
  }

  static std::string name_of(const GridOptions& grid) {
    return "grid of " + std::to_string(grid.directions) + " directions" +
           (grid.cell_m > 0.0 ? " at " + short_number(grid.cell_m) + " m" : "");
  }

  // One point of the sun's disc: what that leaves out of penumbras the probes see, and a finer rung or the
  // reference mends.
  void draw_sun(double target_error, LightMap& map) {
    const StageTimer timer(times_, "drawing sun");
    const auto exposure = sun_exposure(scene_, light_,
                                       {.target_error = target_error,
                                        .sun_directions = 1,
                                        .ground = request_.reference.ground,
                                        .seed = request_.reference.seed},
                                       control_);
    set_direct(scene_, light_, *exposure, map, control_);
  }

  // Relative to the mean direct light, in the band where the sun is the largest part.
  double sun_error_for_tolerance() const {
    if (options_.measure != AutoMeasure::kElementRms) return kSunErrorOfSums;
    double share = 0.0;
    for (std::size_t b = 0; b < light_.bands.size(); ++b) {
      double direct = 0.0, total = 0.0;
      for (const ProbeLight& p : probes_.probes) {
        direct += parts_of(p.bands[b]).direct_w_m2;
        total += p.bands[b].irradiance_w_m2();
      }
      if (total > 0.0) share = std::max(share, direct / total);
    }
    return std::clamp(share > 0.0 ? kSunShare * options_.aim() / share : 1.0, 0.01, 0.5);
  }

  void try_reference() {
    constexpr int kFirstRays = 16;
    LightRequest asked = request_;
    asked.method = Method::kReference;
    ReferenceOptions& o = asked.reference;
    o.rays_per_face = o.sun_rays_per_element = kFirstRays;
    if (options_.measure == AutoMeasure::kElementRms) o.target_relative_error = 0.9 * options_.aim();
    try {
      take(judge().judge("reference", run_timed(asked), {}));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kLimitExceeded) throw;
      notes_.push_back(std::string("reference was not run: ") + error.what());
    }
  }

  // --- by time ---------------------------------------------------------------------------------------

  // Seconds from now on, of the threads at hand. What was measured of the probes corrects the model.
  double predicted_s(double nominal_s) const { return nominal_s * slowness_ / std::max(1, scene_.threads); }

  double needed_before_s() const {
    return ray_scene_s(sizes_) + probes_s(plan_, optics_.band_count(), is_of_groups(options_.measure));
  }

  LightMap best_in_time() {
    const auto start = Clock::now();
    slowness_ = machine_slowness();
    refuse_impossible_time();
    const auto spent_s = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    probe();
    slowness_ = std::max(slowness_, spent_s() * std::max(1, scene_.threads) / needed_before_s() * 0.5);
    run_best_that_fits(*options_.time_s - spent_s());
    if (spent_s() > 1.2 * *options_.time_s)
      notes_.push_back("took longer than time_s of " + short_number(*options_.time_s) +
                       " s: the machine was slower than predicted");
    return finish();
  }

  GridOptions cheapest_grid() const {
    return {.directions = 8, .cell_m = 4.0 * sizes_.leaf_side_m, .convergence = 0.02};
  }

  // Well below what the cheapest way is expected to take, so that no guess of the model refuses what might
  // do.
  void refuse_impossible_time() const {
    const double needed_s =
        predicted_s(needed_before_s() + grid_s(sizes_, cheapest_grid(), optics_.band_count()));
    if (*options_.time_s < 0.5 * needed_s)
      throw_invalid("auto.time_s", short_number(*options_.time_s) + " s is too short for this forest",
                    "about " + short_number(needed_s) + " s or more, which the cheapest way needs here");
  }

  void run_best_that_fits(double left_s) {
    constexpr double kSafety = 0.85;
    const std::size_t bands = optics_.band_count();
    const bool sun = trace::has_beam(light_);
    left_s *= kSafety;
    for (const int rays : {1024, 512, 256, 128}) {
      if (predicted_s(reference_s(sizes_, rays, bands, sun)) > left_s) continue;
      if (run_reference_of(rays)) return;
    }
    std::vector<GridOptions> grids = fitting_rungs(0.0);
    for (std::size_t g = grids.size(); g-- > 0;)
      for (const double sun_error : {0.05, 0.1}) {
        if (!sun) break;
        if (predicted_s(grid_s(sizes_, grids[g], bands) + sun_drawing_s(sizes_, sun_error)) > left_s)
          continue;
        take_with_sun(grids[g], run_grid(grids[g]), sun_error);
        return;
      }
    grids.insert(grids.begin(), cheapest_grid());
    std::size_t g = grids.size() - 1;
    while (g > 0 && predicted_s(grid_s(sizes_, grids[g], bands)) > left_s) --g;
    take(judge().judge(name_of(grids[g]), run_grid(grids[g]),
                       {CorrectionForm::kTotal, CorrectionForm::kParts}));
  }

  bool run_reference_of(int rays) {
    LightRequest asked = request_;
    asked.method = Method::kReference;
    asked.reference.rays_per_face = asked.reference.sun_rays_per_element = rays;
    asked.reference.target_relative_error = 0.0;
    try {
      take(judge().judge("reference of " + std::to_string(rays) + " rays", run_timed(asked), {}));
      return true;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kLimitExceeded) throw;
      return false;
    }
  }

  // --- common ----------------------------------------------------------------------------------------

  LightMap run_timed(const LightRequest& asked) {
    LightMap map = run_(asked);
    auto& times = map.provenance.times;
    times_.times.insert(times_.times.end(), times.begin(), times.end());
    times.clear();
    return map;
  }

  Judge judge() const {
    return {scene_.forest, scene_.index, optics_, probes_, groups_ ? &*groups_ : nullptr, options_};
  }

  // Keeps the better attempt; true if it will do.
  bool take(Attempt attempt) {
    tried_ += (tried_.empty() ? "" : "; ") + attempt.name + " " + short_number(attempt.worst_error);
    const bool tolerable = attempt.tolerable;
    if (!best_ || tolerable || attempt.worst_error < best_->worst_error) best_ = std::move(attempt);
    return tolerable;
  }

  LightMap finish() {
    LightMap map = std::move(best_->map);
    Provenance& p = map.provenance;
    {
      const StageTimer timer(times_, "error bars");
      describe(map);
    }
    p.times = std::move(times_.times);
    p.notes.insert(p.notes.end(), notes_.begin(), notes_.end());
    if (!options_.time_s && !best_->tolerable)
      p.notes.push_back("tolerance " + short_number(options_.aim()) + " of " + to_string(options_.measure) +
                        " not reached: measured " + short_number(best_->worst_error));
    return map;
  }

  void describe(LightMap& map) const {
    Provenance& p = map.provenance;
    if (options_.time_s)
      p.settings.emplace_back("time_s", short_number(*options_.time_s));
    else
      p.settings.emplace_back("tolerance", short_number(options_.aim()));
    p.settings.emplace_back("tolerance_measure", to_string(options_.measure));
    p.settings.emplace_back("chosen_method", best_->name);
    p.settings.emplace_back("tried_methods", tried_);
    add_probe_settings(plan_, p);
    const Resamples resamples(probes_.probes.size(), plan_.seed);
    for (std::size_t b = 0; b < map.bands.size(); ++b) {
      const JudgedBand& judged = best_->bands[b];
      if (judged.correction)
        p.settings.emplace_back("correction." + map.bands[b].band, to_text(*judged.correction));
      add_error_bar(judged.sample, resamples, map.bands[b], p);
      if (judged.group) add_group_bar(*judged.group, options_.measure, plan_.seed, map.bands[b].band, p);
    }
  }

  const LightScene& scene_;
  const OpticsTable& optics_;
  const Illumination& light_;
  const LightRequest& request_;
  const AutoOptions& options_;
  const ProbePlan plan_;
  const MethodRunner& run_;
  const RunControl& control_;
  const SceneSizes sizes_;
  double slowness_ = 1.0;
  std::unique_ptr<ProbeScene> rays_;
  ProbeSet probes_;
  std::optional<GroupProbes> groups_;
  Provenance times_;  // of all attempts
  std::optional<Attempt> best_;
  std::string tried_;
  std::vector<std::string> notes_;
};

}  // namespace

LightMap auto_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                        const LightRequest& request, const MethodRunner& run, const RunControl& control) {
  check_options(request.automatic);
  check_options(request.probes.value_or(ProbePlan{}));
  return Ladder(scene, optics, light, request, run, control).climb();
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
