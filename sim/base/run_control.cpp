#include "sim/base/run_control.h"

#include "sim/base/error.h"

namespace sunfleck {

void RunControl::check() const {
  if (stop.stop_requested()) throw_cancelled();
}

}  // namespace sunfleck
