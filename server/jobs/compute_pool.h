// The only threads that compute for calls: a few workers behind a short queue. What does not fit is refused
// at once, so that a caller knows within milliseconds.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace sunfleck {

class ComputePool {
 public:
  // Exactly one of `run` (on a worker) and `abandon` (stopped before it began) is called; neither may throw.
  struct Job {
    std::function<void()> run, abandon;
    std::stop_token stop;
  };
  struct Load {
    std::size_t running = 0, queued = 0;
  };

  ComputePool(std::size_t workers, std::size_t queue_length);
  ~ComputePool();  // abandons what is queued, waits for what runs
  ComputePool(const ComputePool&) = delete;
  ComputePool& operator=(const ComputePool&) = delete;

  bool try_submit(Job job);  // false: all workers are busy and the queue is full
  void discard_stopped();    // abandons queued jobs whose token was stopped, on the caller's thread
  Load load() const;
  std::size_t workers() const { return threads_.size(); }

 private:
  void work(std::stop_token ending);
  std::vector<Job> take_stopped_locked();

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Job> queue_;
  std::size_t running_ = 0;
  const std::size_t queue_length_;
  std::vector<std::jthread> threads_;
};

}  // namespace sunfleck
