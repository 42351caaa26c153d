// The scenes of a server: in memory, named by content, immutable, within a byte budget. Safe from all
// threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "lighting/plan/light_session.h"
#include "sim/base/error.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct StoredScene {
  std::string name;  // scenes/{sha256}
  Forest forest;
  std::uint64_t seed = 0;
  std::uint64_t elements = 0;
  double leaf_area_m2 = 0;
  Box bounds;
  std::uint64_t memory_bytes = 0;
  std::chrono::system_clock::time_point created;
  // What lighting prepared for this forest; null where there is nothing to light. Safe from all threads.
  std::unique_ptr<const LightSession> session;
};
using ScenePtr = std::shared_ptr<const StoredScene>;

// The scene asked for is not there: tells the name, which is the client's own word.
class UnknownScene : public Error {
 public:
  explicit UnknownScene(const std::string& name);
};

// Counts, hashes and measures a forest. `prepared` is shared by all scenes of a server: one budget.
ScenePtr make_scene(Forest forest, std::uint64_t seed, const std::shared_ptr<PreparedCache>& prepared);

class SceneStore {
 public:
  explicit SceneStore(std::uint64_t budget_bytes) : budget_bytes_(budget_bytes) {}

  // The scene of that name that is there already, else this one. Throws Error(kLimitExceeded) if it does not
  // fit.
  ScenePtr add(ScenePtr scene);
  ScenePtr find(const std::string& name) const;  // throws UnknownScene
  bool contains(const std::string& name) const;
  void remove(const std::string& name);  // throws UnknownScene; who computes on it goes on
  // At most `count` scenes whose names come after `after`, by name.
  std::vector<ScenePtr> list(const std::string& after, std::size_t count) const;

  std::size_t size() const;
  std::uint64_t bytes() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, ScenePtr> scenes_;
  std::uint64_t bytes_ = 0;
  const std::uint64_t budget_bytes_;
};

}  // namespace sunfleck
