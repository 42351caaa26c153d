// Parallel loops whose result does not depend on the number of threads: fixed chunks, every chunk writes only
// its own outputs, sums are taken chunk by chunk in order. Threads are those of the caller's TBB arena.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "sim/base/run_control.h"

namespace sunfleck {

// Calls body(begin, end) for consecutive ranges of at most `chunk` indexes that cover [0, count). Looks at
// the stop token before each chunk (choose chunks of <= 10 ms) and reports progress under `stage` unless it
// is empty. Rethrows the first exception; throws Error(kCancelled) when stopped.
void for_each_chunk(std::size_t count, std::size_t chunk, const RunControl& control, std::string_view stage,
                    const std::function<void(std::size_t begin, std::size_t end)>& body);

// Sum of term(i) over [0, count): chunk sums in parallel, added in order.
double ordered_sum(std::size_t count, const std::function<double(std::size_t)>& term);

// Runs `work` with at most `threads` threads (0: all cores of the process).
void with_threads(int threads, const std::function<void()>& work);

}  // namespace sunfleck
