#include "lighting/plan/auto_time.h"

#include <algorithm>
#include <functional>
#include <optional>

#include "lighting/plan/auto_report.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr double kSafety = 0.85;        // of the time left that the model may fill
constexpr double kShareOfProbes = 0.3;  // of the time
constexpr int kFewestProbes = 64;

class InTime {
 public:
  InTime(AutoRun& run, const TimeLeft& time, const RunControl& control)
      : run_(run), time_(time), control_(control), slowness_(machine_slowness()) {}

  LightMap answer(ProbePlan plan) {
    refuse_impossible_time(plan);
    probe(plan);
    const std::vector<Rung> rungs =
        rungs_for_elements(run_.sizes(), run_.spread(), run_.request(), kTightAim, run_.has_sun());
    run_best_of(rungs);
    if (time_.left_s() < -0.1 * time_.all_s())
      run_.note("took " + short_number(time_.spent_s()) + " s, longer than time_s of " +
                short_number(time_.all_s()) + " s: the machine was slower than predicted");
    return run_.answer();
  }

 private:
  static constexpr double kTightAim = 0.05;  // what rungs are sized for: the sun's picture, mainly

  // Seconds from now on, of the threads at hand.
  double predicted_s(double nominal_s) const {
    return nominal_s * slowness_ / std::max(1, run_.scene().threads);
  }

  // Well below what the cheapest way is expected to take, so that no guess of the model refuses what might
  // do.
  void refuse_impossible_time(ProbePlan plan) const {
    plan.count = std::min(plan.count, kFewestProbes);
    const double needed_s =
        predicted_s(ray_scene_s(run_.sizes()) + probes_s(plan, run_.bands(), !run_.is_of_elements()) +
                    grid_s(run_.sizes(), smallest_rung(run_).grid, run_.bands()));
    if (time_.all_s() < 0.5 * needed_s)
      throw_invalid("auto.time_s", short_number(time_.all_s()) + " s is too short for this forest",
                    "about " + short_number(needed_s) + " s or more, which the cheapest way needs here");
  }

  // As many as a part of the time holds. What they took corrects the model.
  void probe(ProbePlan plan) {
    const double one_s = predicted_s(probes_s(plan, run_.bands(), !run_.is_of_elements())) / plan.count;
    const double affordable = kShareOfProbes * time_.all_s() / one_s;
    if (affordable < plan.count)
      plan.count = std::max(std::min(plan.count, kFewestProbes), static_cast<int>(affordable));
    const double before_s = time_.spent_s();
    const double nominal_s = ray_scene_s(run_.sizes()) + probes_s(plan, run_.bands(), !run_.is_of_elements());
    run_.probe(plan, control_);
    const double took_s = (time_.spent_s() - before_s) * std::max(1, run_.scene().threads);
    slowness_ = std::max(slowness_, 0.5 * took_s / nominal_s);
  }

  bool fits(const Rung& rung) const { return predicted_s(rung.predicted_s) <= kSafety * time_.left_s(); }

  std::optional<Rung> best_that_fits(const std::vector<Rung>& rungs, bool rays) const {
    std::optional<Rung> best;
    for (const Rung& rung : rungs)
      if (is_of_rays(rung) == rays && fits(rung) && (!best || rung.predicted_error < best->predicted_error))
        best = rung;
    return best;
  }

  static bool is_of_rays(const Rung& rung) {
    return rung.kind == RungKind::kLinks || rung.kind == RungKind::kReference;
  }

  // Rays only with another answer at hand, which takes a small part of their time, and while it lasts.
  void run_best_of(const std::vector<Rung>& rungs) {
    const std::optional<Rung> rays = best_that_fits(rungs, true), grid = best_that_fits(rungs, false);
    if (!rays || (grid && grid->predicted_error <= rays->predicted_error)) {
      run_.attempt(grid.value_or(smallest_rung(run_)), control_);
      return;
    }
    Rung at_hand = smallest_rung(run_);
    for (const Rung& rung : rungs)
      if (!is_of_rays(rung) && rung.predicted_s < 0.15 * rays->predicted_s &&
          rung.predicted_error < at_hand.predicted_error)
        at_hand = rung;
    run_.attempt(at_hand, control_);
    const std::optional<Rung> still = best_that_fits(rungs, true);
    if (!still) {
      run_.note(rays->name() + " was not started: it would have overrun time_s");
      return;
    }
    attempt_while_time_lasts(*still);
  }

  void attempt_while_time_lasts(const Rung& rung) {
    const Deadline deadline(control_, time_.left_s());
    try {
      run_.attempt(rung, deadline.control());
    } catch (const Error& error) {
      control_.check();  // stopped by the caller
      if (error.kind() == ErrorKind::kCancelled)
        run_.note(rung.name() + " was stopped when time_s of " + short_number(time_.all_s()) +
                  " s was over: the answer is what there was before");
      else if (error.kind() == ErrorKind::kLimitExceeded)
        run_.note(rung.name() + " was not run: " + error.what());
      else
        throw;
    }
  }

  AutoRun& run_;
  const TimeLeft& time_;
  const RunControl& control_;
  double slowness_;
};

}  // namespace

Deadline::Deadline(const RunControl& outer, double in_s)
    : control_{source_.get_token(), outer.progress},
      outer_(outer.stop, [this] { source_.request_stop(); }),
      thread_([this, in_s] { wait(in_s); }) {}

Deadline::~Deadline() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  done_changed_.notify_all();
  thread_.join();
}

void Deadline::wait(double in_s) {
  std::unique_lock lock(mutex_);
  if (done_changed_.wait_for(lock, std::chrono::duration<double>(std::max(0.0, in_s)), [&] { return done_; }))
    return;
  passed_ = true;
  source_.request_stop();
}

Rung smallest_rung(const AutoRun& run) {
  Rung rung;
  rung.kind = RungKind::kGrid;
  rung.grid.directions = 8;
  rung.grid.cell_m = 4.0 * run.sizes().leaf_side_m;
  rung.grid.convergence = 0.02;
  rung.predicted_error = 1.0;
  rung.predicted_s = grid_s(run.sizes(), rung.grid, run.bands());
  return rung;
}

LightMap answer_in_time(AutoRun& run, ProbePlan plan, const TimeLeft& time, const RunControl& control) {
  return InTime(run, time, control).answer(plan);
}

}  // namespace sunfleck
