// How a long computation is watched and stopped. Every such function takes a RunControl and looks at it at
// least every 10 ms of work.
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace sunfleck {

// `fraction` of the named stage that is done, in [0, 1]. Called from any thread, never from two at once for
// one RunControl; must return quickly.
using ProgressSink = std::function<void(std::string_view stage, double fraction)>;

struct RunControl {
  std::stop_token stop;
  ProgressSink progress;

  void check() const;  // throws Error(kCancelled) once a stop was requested
  void report(std::string_view stage, double fraction) const {
    if (progress) progress(stage, fraction);
  }
};

}  // namespace sunfleck
