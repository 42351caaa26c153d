#include "sim/base/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

#ifdef __SANITIZE_THREAD__
// The thread sanitizer does not see the synchronisation inside Debian's TBB and would report races that are
// none: under it two plain threads share the indexes.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  std::mutex failing;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (std::size_t i; (i = next++) < count;) body(i);
    } catch (...) {
      const std::lock_guard lock(failing);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::thread other(work);
  work();
  other.join();
  if (failure) std::rethrow_exception(failure);
}
#else
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, count, body, tbb::simple_partitioner());
}
#endif

}  // namespace

void for_each_chunk(std::size_t count, std::size_t chunk, const RunControl& control, std::string_view stage,
                    const std::function<void(std::size_t, std::size_t)>& body) {
  SUNFLECK_EXPECTS(chunk > 0);
  control.check();
  if (count == 0) return;
  const std::size_t chunks = (count + chunk - 1) / chunk;
  std::atomic<std::size_t> done{0};
  std::mutex reporting;
  double reported = 0.0;
  for_each_index(chunks, [&](std::size_t c) {
    control.check();
    body(c * chunk, std::min(count, (c + 1) * chunk));
    const double fraction = static_cast<double>(++done) / static_cast<double>(chunks);
    if (stage.empty() || !control.progress) return;
    const std::lock_guard lock(reporting);
    if (fraction <= reported) return;
    reported = fraction;
    control.report(stage, fraction);
  });
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
  const int cores = tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : tbb::task_arena::automatic);
  arena.execute(work);
}

}  // namespace sunfleck
