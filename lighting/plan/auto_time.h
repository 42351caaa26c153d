// `auto` within a time: what the cost model says fits is started, a clock watches it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "lighting/plan/auto_run.h"

namespace sunfleck {

// A time that began when this was made.
class TimeLeft {
 public:
  explicit TimeLeft(double time_s) : time_s_(time_s) {}
  double spent_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  double left_s() const { return time_s_ - spent_s(); }
  double all_s() const { return time_s_; }

 private:
  double time_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Stops work when its time is over, or when the control that it was made from is stopped.
class Deadline {
 public:
  Deadline(const RunControl& outer, double in_s);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  const RunControl& control() const { return control_; }
  bool passed() const { return passed_.load(); }

 private:
  void wait(double in_s);

  std::stop_source source_;
  RunControl control_;
  std::atomic<bool> passed_{false};
  std::mutex mutex_;
  std::condition_variable done_changed_;
  bool done_ = false;
  std::stop_callback<std::function<void()>> outer_;
  std::thread thread_;
};

// The cheapest thing that gives an answer at all.
Rung smallest_rung(const AutoRun& run);

// Throws Error(kInvalidInput) naming "auto.time_s" where the time is far too short, before any work.
LightMap answer_in_time(AutoRun& run, ProbePlan plan, const TimeLeft& time, const RunControl& control);

}  // namespace sunfleck
