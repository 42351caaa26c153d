// What estimators prepare once and use again (ray scenes, stored hits, leaf-area grids, depths), kept by name
// within a byte budget, the least recently used forgotten first. Safe from all threads: who asks for
// something that another thread is making waits for it (looking at its own stop token) instead of making it
// twice.
//
// A thing must depend on nothing but what its key says and what the prefix stands for (a forest that does not
// change): then an answer has the same bytes with and without the cache.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

#include "sim/base/run_control.h"
#include "sim/base/vec.h"

namespace sunfleck {

// The name of a prepared thing: what it is and every number it depends on, exactly.
class PreparedKey {
 public:
  explicit PreparedKey(std::string_view what) : text_(what) {}
  PreparedKey& add(std::string_view name, double value);
  PreparedKey& add(std::string_view name, std::uint64_t value);
  PreparedKey& add(std::string_view name, int value);
  PreparedKey& add(std::string_view name, const Vec3& value);
  PreparedKey& add(std::string_view name, std::string_view value);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class PreparedCache {
 public:
  struct Stats {
    std::uint64_t bytes = 0, entries = 0, found = 0, made = 0, dropped = 0;
  };

  explicit PreparedCache(std::uint64_t budget_bytes) : budget_bytes_(budget_bytes) {}
  PreparedCache(const PreparedCache&) = delete;
  PreparedCache& operator=(const PreparedCache&) = delete;

  // The thing of that name under `prefix`, made by `make` if it is not there. `bytes_of` tells its size. What
  // is larger than the whole budget is handed out but not kept. Rethrows what `make` throws, and nothing is
  // kept then; throws Error(kCancelled) when stopped while waiting.
  template <class T>
  std::shared_ptr<const T> get(const std::string& prefix, const PreparedKey& key, const RunControl& control,
                               const std::function<std::shared_ptr<const T>()>& make,
                               const std::function<std::uint64_t(const T&)>& bytes_of) {
    return std::static_pointer_cast<const T>(get_any(prefix + key.text(), control, [&] {
      std::shared_ptr<const T> made = make();
      const std::uint64_t bytes = bytes_of(*made);
      return Made{std::move(made), bytes};
    }));
  }

  bool contains(const std::string& prefix, const PreparedKey& key) const;
  void forget(const std::string& prefix);  // everything whose name begins so; who holds it goes on
  Stats stats() const;

 private:
  struct Made {
    std::shared_ptr<const void> thing;
    std::uint64_t bytes = 0;
  };
  struct Slot {
    Made made;
    bool ready = false, failed = false;
    std::list<std::string>::iterator place;  // in use_, once ready
  };
  std::shared_ptr<const void> get_any(const std::string& key, const RunControl& control,
                                      const std::function<Made()>& make);
  std::shared_ptr<const void> make_now(const std::string& key, const std::shared_ptr<Slot>& slot,
                                       const std::function<Made()>& make);
  void drop_locked(const std::string& key, std::list<std::shared_ptr<Slot>>& gone);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::unordered_map<std::string, std::shared_ptr<Slot>> slots_;
  std::list<std::string> use_;  // the latest used first; ready slots only
  Stats stats_;
  const std::uint64_t budget_bytes_;
};

// A cache seen by the estimators of one forest.
struct PreparedStore {
  PreparedCache& cache;
  std::string prefix;

  template <class T>
  std::shared_ptr<const T> get(const PreparedKey& key, const RunControl& control,
                               const std::function<std::shared_ptr<const T>()>& make,
                               const std::function<std::uint64_t(const T&)>& bytes_of) const {
    return cache.get<T>(prefix, key, control, make, bytes_of);
  }
};

}  // namespace sunfleck
