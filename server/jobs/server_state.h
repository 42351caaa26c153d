// What the handlers of one server share.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <stop_token>
#include <string>

#include "lighting/plan/light_request.h"
#include "server/convert/limits.h"
#include "server/jobs/compute_pool.h"
#include "server/jobs/deadline_watch.h"
#include "server/jobs/light_map_cache.h"
#include "server/jobs/running_renders.h"
#include "server/jobs/scene_store.h"
#include "sim/plant/species.h"

namespace spdlog {
class logger;
}

namespace sunfleck {

struct ServerState {
  ServerState(const Limits& limits_in_force, SpeciesLibrary known_species,
              std::shared_ptr<spdlog::logger> logger);

  const Limits limits;
  const SpeciesLibrary species;
  const std::shared_ptr<spdlog::logger> log;
  const std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  std::atomic<bool> draining{false};              // new calls are refused
  std::stop_source ending;                        // running calls are stopped
  std::atomic<int> live_calls{0};                 // that still may touch this
  const std::shared_ptr<PreparedCache> prepared;  // of all scenes
  SceneStore scenes;
  LightMapCache light_maps;
  RunningRenders renders;
  DeadlineWatch watch;
  ComputePool pool;  // last: its threads end before what they use
};

// The limits with every "0: from the machine" filled in.
Limits with_machine_defaults(Limits limits);

// The light map of a scene, from the cache or computed. Throws Error(kLimitExceeded) before it begins if it
// would need more memory than one request may have.
struct LightAnswer {
  LightMapPtr map;
  bool from_cache = false;
};
LightAnswer light_map_of(ServerState& state, const StoredScene& scene, const LightRequest& request,
                         const RunControl& control);

}  // namespace sunfleck
