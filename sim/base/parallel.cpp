#include "sim/base/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <vector>

#include "sim/base/contract.h"

namespace sunfleck {

void for_each_chunk(std::size_t count, std::size_t chunk, const RunControl& control, std::string_view stage,
                    const std::function<void(std::size_t, std::size_t)>& body) {
  SUNFLECK_EXPECTS(chunk > 0);
  control.check();
  if (count == 0) return;
  const std::size_t chunks = (count + chunk - 1) / chunk;
  std::atomic<std::size_t> done{0};
  std::mutex reporting;
  double reported = 0.0;
  tbb::parallel_for(
      std::size_t{0}, chunks,
      [&](std::size_t c) {
        control.check();
        body(c * chunk, std::min(count, (c + 1) * chunk));
        const double fraction = static_cast<double>(++done) / static_cast<double>(chunks);
        if (stage.empty() || !control.progress) return;
        const std::lock_guard lock(reporting);
        if (fraction <= reported) return;
        reported = fraction;
        control.report(stage, fraction);
      },
      tbb::simple_partitioner());
}

double ordered_sum(std::size_t count, const std::function<double(std::size_t)>& term) {
  constexpr std::size_t kChunk = 4096;
  std::vector<double> partial((count + kChunk - 1) / kChunk, 0.0);
  for_each_chunk(count, kChunk, {}, {}, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += term(i);
    partial[begin / kChunk] = sum;
  });
  double total = 0.0;
  for (const double p : partial) total += p;
  return total;
}

void with_threads(int threads, const std::function<void()>& work) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute(work);
}

}  // namespace sunfleck
