// Head comment in compute_pool.h.
#include "server/jobs/compute_pool.h"

#include <algorithm>

#include "sim/base/contract.h"

namespace sunfleck {

ComputePool::ComputePool(std::size_t workers, std::size_t queue_length) : queue_length_(queue_length) {
  SUNFLECK_EXPECTS(workers > 0);
  threads_.reserve(workers);
  for (std::size_t i = 0; i < workers; ++i) {
    threads_.emplace_back([this](std::stop_token ending) { work(ending); });
  }
}

ComputePool::~ComputePool() {
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();
  for (Job& job : queue_) job.abandon();
}

bool ComputePool::try_submit(Job job) {
  std::vector<Job> stopped;
  bool accepted = false;
  {
    const std::lock_guard lock(mutex_);
    stopped = take_stopped_locked();
    // An idle worker takes the job at once: the queue proper holds what is beyond the workers.
    const std::size_t idle = threads_.size() - running_;
    accepted = queue_.size() < queue_length_ + idle;
    if (accepted) queue_.push_back(std::move(job));
  }
  if (accepted) changed_.notify_one();
  for (Job& gone : stopped) gone.abandon();
  return accepted;
}

void ComputePool::discard_stopped() {
  std::vector<Job> stopped;
  {
    const std::lock_guard lock(mutex_);
    stopped = take_stopped_locked();
  }
  for (Job& gone : stopped) gone.abandon();
}

std::vector<ComputePool::Job> ComputePool::take_stopped_locked() {
  std::vector<Job> stopped;
  for (auto it = queue_.begin(); it != queue_.end();) {
    if (it->stop.stop_requested()) {
      stopped.push_back(std::move(*it));
      it = queue_.erase(it);
    } else {
      ++it;
    }
  }
  return stopped;
}

ComputePool::Load ComputePool::load() const {
  const std::lock_guard lock(mutex_);
  const std::size_t idle = threads_.size() - running_;
  const std::size_t starting = std::min(idle, queue_.size());
  return {running_ + starting, queue_.size() - starting};
}

void ComputePool::work(std::stop_token ending) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, ending, [this] { return !queue_.empty(); }) && !ending.stop_requested()) {
    Job job = std::move(queue_.front());
    queue_.pop_front();
    ++running_;
    lock.unlock();
    job.stop.stop_requested() ? job.abandon() : job.run();
    job = {};  // what it holds is freed before the worker counts as idle
    lock.lock();
    --running_;
  }
}

}  // namespace sunfleck
