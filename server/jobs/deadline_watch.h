// One thread that calls back when a time has come: deadlines of calls and readers that stall.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace sunfleck {

class DeadlineWatch {
 public:
  using Clock = std::chrono::steady_clock;
  using Id = std::uint64_t;

  DeadlineWatch();
  ~DeadlineWatch();
  DeadlineWatch(const DeadlineWatch&) = delete;
  DeadlineWatch& operator=(const DeadlineWatch&) = delete;

  // `expired` runs once on the watch's thread, without locks held; it must be short and must not throw.
  Id add(Clock::time_point when, std::function<void()> expired);
  void move(Id id, Clock::time_point when);  // nothing happens if it has expired or was removed
  void remove(Id id);                        // a callback that has begun goes on

 private:
  struct Entry {
    Clock::time_point when;
    std::function<void()> expired;
  };
  void watch(std::stop_token ending);
  Clock::time_point earliest_locked() const;

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::map<Id, Entry> entries_;
  Id next_id_ = 1;
  std::uint64_t changes_ = 0;
  std::jthread thread_;
};

}  // namespace sunfleck
