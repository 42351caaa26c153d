// Head comment in light_map_cache.h. A few dozen entries at most, so that a list is enough.
#include "server/jobs/light_map_cache.h"

#include <algorithm>

#include "server/convert/light_map_message.h"

namespace sunfleck {

LightMapPtr LightMapCache::find(const std::string& scene, const std::string& request) {
  const std::lock_guard lock(mutex_);
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& e) { return e.request == request && e.scene == scene; });
  if (entry == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, entry);
  return entry->map;
}

void LightMapCache::add(const std::string& scene, const std::string& request, LightMapPtr map) {
  const std::uint64_t size = memory_bytes(*map);
  if (size > budget_bytes_ || find(scene, request)) return;
  std::list<Entry> gone;  // freed after the lock
  const std::lock_guard lock(mutex_);
  while (bytes_ + size > budget_bytes_) {
    bytes_ -= entries_.back().bytes;
    gone.splice(gone.end(), entries_, std::prev(entries_.end()));
  }
  entries_.push_front({scene, request, std::move(map), size});
  bytes_ += size;
}

void LightMapCache::forget_scene(const std::string& scene) {
  const std::lock_guard lock(mutex_);
  for (auto it = entries_.begin(); it != entries_.end();) {
    if (it->scene == scene) {
      bytes_ -= it->bytes;
      it = entries_.erase(it);
    } else {
      ++it;
    }
  }
}

std::size_t LightMapCache::size() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

std::uint64_t LightMapCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace sunfleck
