#include "server/apps/terminal.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

class ProgressLine {
 public:
  void show(std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    const int quarter = static_cast<int>(fraction * 4);
    const bool new_stage = stage != stage_;
    const bool worth_it = terminal_
                              ? new_stage || fraction >= 1.0 || now - shown_ >= std::chrono::milliseconds(250)
                              : new_stage || quarter > quarter_;
    if (!worth_it) return;
    if (new_stage && open_) end_line();
    stage_ = stage;
    quarter_ = quarter;
    shown_ = now;
    std::fprintf(stderr, "%s  %-22s %3.0f %%%s", terminal_ ? "\r" : "", stage_.c_str(), 100 * fraction,
                 terminal_ ? "" : "\n");
    open_ = terminal_;
  }

  void finish() {
    const std::lock_guard lock(mutex_);
    if (open_) end_line();
    stage_.clear();
    quarter_ = 0;
  }

 private:
  void end_line() {
    std::fputc('\n', stderr);
    open_ = false;
  }

  std::mutex mutex_;
  std::string stage_;
  int quarter_ = 0;
  bool terminal_ = isatty(STDERR_FILENO) != 0, open_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

ProgressLine& progress_line() {
  static ProgressLine line;
  return line;
}

// A thread that waits for the signals: no work is done inside a signal handler.
std::stop_token stop_on_signal() {
  static std::stop_source source = [] {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::stop_source made;
    std::thread([made, signals]() mutable {
      int received = 0;
      sigwait(&signals, &received);
      made.request_stop();
      sigwait(&signals, &received);  // asked twice: leave at once
      _exit(130);
    }).detach();
    return made;
  }();
  return source.get_token();
}

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInvalidInput:
    case ErrorKind::kNotFound:
    case ErrorKind::kLimitExceeded:
      return 2;
    case ErrorKind::kCancelled:
      return 130;
    case ErrorKind::kInputOutput:
      return 1;
  }
  return 1;
}

}  // namespace

RunControl terminal_control() {
  return {stop_on_signal(),
          [](std::string_view stage, double fraction) { progress_line().show(stage, fraction); }};
}

void finish_progress() { progress_line().finish(); }

int run_and_report(const std::function<void()>& command) {
  try {
    command();
    finish_progress();
    return 0;
  } catch (const Error& error) {
    finish_progress();
    std::fprintf(stderr, "sunfleck: %s\n", error.what());
    return exit_code(error.kind());
  } catch (const std::bad_alloc&) {
    finish_progress();
    std::fprintf(stderr, "sunfleck: not enough memory for this (a smaller forest, picture or grid)\n");
    return exit_code(ErrorKind::kLimitExceeded);
  } catch (const std::exception& error) {
    finish_progress();
    std::fprintf(stderr, "sunfleck: internal error: %s\n", error.what());
    return 1;
  }
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (int i = static_cast<int>(text.size()) - 3; i > 0; i -= 3)
    text.insert(static_cast<std::size_t>(i), ",");
  return text;
}

std::string seconds_text(double seconds) {
  char text[32];
  if (seconds >= 1.0)
    std::snprintf(text, sizeof text, "%.2f s", seconds);
  else
    std::snprintf(text, sizeof text, "%.1f ms", 1e3 * seconds);
  return text;
}

}  // namespace sunfleck
