// Head comment in deadline_watch.h. A few hundred entries at most, so that a walk over all is cheap.
#include "server/jobs/deadline_watch.h"

#include <algorithm>
#include <vector>

namespace sunfleck {

DeadlineWatch::DeadlineWatch() : thread_([this](std::stop_token ending) { watch(ending); }) {}

DeadlineWatch::~DeadlineWatch() = default;

DeadlineWatch::Id DeadlineWatch::add(Clock::time_point when, std::function<void()> expired) {
  const std::lock_guard lock(mutex_);
  const Id id = next_id_++;
  entries_.emplace(id, Entry{when, std::move(expired)});
  ++changes_;
  changed_.notify_one();
  return id;
}

void DeadlineWatch::move(Id id, Clock::time_point when) {
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  const bool wakes_earlier = when < entry->second.when;
  entry->second.when = when;
  if (!wakes_earlier) return;  // the thread looks again at the old time at the latest
  ++changes_;
  changed_.notify_one();
}

void DeadlineWatch::remove(Id id) {
  Entry gone;  // freed after the lock: what it holds may come back here
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  gone = std::move(entry->second);
  entries_.erase(entry);
}

DeadlineWatch::Clock::time_point DeadlineWatch::earliest_locked() const {
  Clock::time_point earliest = Clock::now() + std::chrono::hours(1);
  for (const auto& [id, entry] : entries_) earliest = std::min(earliest, entry.when);
  return earliest;
}

void DeadlineWatch::watch(std::stop_token ending) {
  std::unique_lock lock(mutex_);
  while (!ending.stop_requested()) {
    std::vector<std::function<void()>> due;
    const Clock::time_point now = Clock::now();
    for (auto it = entries_.begin(); it != entries_.end();) {
      if (it->second.when <= now) {
        due.push_back(std::move(it->second.expired));
        it = entries_.erase(it);
      } else {
        ++it;
      }
    }
    if (due.empty()) {
      changed_.wait_until(lock, ending, earliest_locked(),
                          [this, seen = changes_] { return changes_ != seen; });
      continue;
    }
    lock.unlock();
    for (const std::function<void()>& expired : due) expired();
    due.clear();
    lock.lock();
  }
}

}  // namespace sunfleck
