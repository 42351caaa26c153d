#include "lighting/base/prepared_cache.h"

#include <chrono>
#include <cstdio>

namespace sunfleck {
namespace {

// Every double by its exact value; both zeros are the same number.
std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", value == 0.0 ? 0.0 : value);
  return text;
}

}  // namespace

PreparedKey& PreparedKey::add(std::string_view name, std::string_view value) {
  text_.append(" ").append(name).append("=").append(value);
  return *this;
}

PreparedKey& PreparedKey::add(std::string_view name, double value) { return add(name, exact(value)); }

PreparedKey& PreparedKey::add(std::string_view name, std::uint64_t value) {
  return add(name, std::string_view(std::to_string(value)));
}

PreparedKey& PreparedKey::add(std::string_view name, int value) {
  return add(name, std::string_view(std::to_string(value)));
}

PreparedKey& PreparedKey::add(std::string_view name, const Vec3& value) {
  return add(name, exact(value.x) + "," + exact(value.y) + "," + exact(value.z));
}

std::shared_ptr<const void> PreparedCache::get_any(const std::string& key, const RunControl& control,
                                                   const std::function<Made()>& make) {
  std::unique_lock lock(mutex_);
  while (true) {
    control.check();
    const auto found = slots_.find(key);
    if (found == slots_.end()) break;
    const std::shared_ptr<Slot> slot = found->second;
    while (!slot->ready && !slot->failed) {
      changed_.wait_for(lock, std::chrono::milliseconds(5));
      control.check();
    }
    if (slot->failed) continue;  // whoever made it was stopped, perhaps: look again
    ++stats_.found;
    // What was dropped meanwhile, or was too large to be kept, is still good for who waited for it.
    if (const auto kept = slots_.find(key); kept != slots_.end() && kept->second == slot)
      use_.splice(use_.begin(), use_, slot->place);
    return slot->made.thing;
  }
  const auto slot = std::make_shared<Slot>();
  slots_.emplace(key, slot);
  lock.unlock();
  return make_now(key, slot, make);
}

std::shared_ptr<const void> PreparedCache::make_now(const std::string& key, const std::shared_ptr<Slot>& slot,
                                                    const std::function<Made()>& make) {
  Made made;
  try {
    made = make();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    slot->failed = true;
    slots_.erase(key);
    changed_.notify_all();
    throw;
  }
  std::list<std::shared_ptr<Slot>> gone;  // freed after the lock
  const std::lock_guard lock(mutex_);
  ++stats_.made;
  slot->made = made;
  slot->ready = true;
  slot->place = use_.insert(use_.begin(), key);
  stats_.bytes += made.bytes;
  if (made.bytes > budget_bytes_) {
    drop_locked(key, gone);
  } else {
    while (stats_.bytes > budget_bytes_) drop_locked(use_.back(), gone);
  }
  changed_.notify_all();
  return made.thing;
}

void PreparedCache::drop_locked(const std::string& key, std::list<std::shared_ptr<Slot>>& gone) {
  const auto found = slots_.find(key);
  const std::shared_ptr<Slot> slot = found->second;
  gone.push_back(slot);
  stats_.bytes -= slot->made.bytes;
  ++stats_.dropped;
  slots_.erase(found);
  use_.erase(slot->place);
}

bool PreparedCache::contains(const std::string& prefix, const PreparedKey& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = slots_.find(prefix + key.text());
  return found != slots_.end() && found->second->ready;
}

void PreparedCache::forget(const std::string& prefix) {
  std::list<std::shared_ptr<Slot>> gone;  // freed after the lock
  const std::lock_guard lock(mutex_);
  for (auto it = use_.begin(); it != use_.end();) {
    const std::string key = *it++;
    if (key.starts_with(prefix)) drop_locked(key, gone);
  }
}

PreparedCache::Stats PreparedCache::stats() const {
  const std::lock_guard lock(mutex_);
  Stats stats = stats_;
  stats.entries = use_.size();
  return stats;
}

}  // namespace sunfleck
