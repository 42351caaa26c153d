// Finished light maps, the least recently used forgotten first: a render after a light map need not light
// again.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "lighting/base/light_map.h"

namespace sunfleck {

using LightMapPtr = std::shared_ptr<const LightMap>;

class LightMapCache {
 public:
  explicit LightMapCache(std::uint64_t budget_bytes) : budget_bytes_(budget_bytes) {}

  LightMapPtr find(const std::string& scene, const std::string& request);  // null if it is not there
  // A map larger than the whole budget is not kept.
  void add(const std::string& scene, const std::string& request, LightMapPtr map);
  void forget_scene(const std::string& scene);

  std::size_t size() const;
  std::uint64_t bytes() const;

 private:
  struct Entry {
    std::string scene, request;
    LightMapPtr map;
    std::uint64_t bytes;
  };
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  // the latest used first
  std::uint64_t bytes_ = 0;
  const std::uint64_t budget_bytes_;
};

}  // namespace sunfleck
