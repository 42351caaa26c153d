// Head comment in server_state.h.
#include "server/jobs/server_state.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "server/convert/light_spec_message.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// The memory this process may use: that of the machine, or of its control group where that is less.
std::uint64_t machine_bytes() {
  auto bytes =
      static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  std::ifstream group("/sys/fs/cgroup/memory.max");  // holds "max" where there is no limit
  std::uint64_t limit = 0;
  if (group >> limit && limit > 0) bytes = std::min(bytes, limit);
  return bytes;
}

}  // namespace

ServerState::ServerState(const Limits& limits_in_force, SpeciesLibrary known_species,
                         std::shared_ptr<spdlog::logger> logger)
    : limits(limits_in_force),
      species(std::move(known_species)),
      log(std::move(logger)),
      prepared(std::make_shared<PreparedCache>(limits.prepared_bytes)),
      scenes(limits.scene_store_bytes),
      light_maps(limits.light_map_cache_bytes),
      pool(limits.running_calls, limits.queued_calls) {}

Limits with_machine_defaults(Limits limits) {
  const std::uint64_t memory = machine_bytes();
  if (limits.scene_store_bytes == 0) limits.scene_store_bytes = memory / 10;
  if (limits.light_map_cache_bytes == 0) limits.light_map_cache_bytes = memory / 20;
  if (limits.prepared_bytes == 0) limits.prepared_bytes = memory / 20;
  if (limits.request_memory_bytes == 0) limits.request_memory_bytes = memory / 20 * 3;
  if (limits.running_calls == 0) limits.running_calls = std::max(1u, std::thread::hardware_concurrency());
  return limits;
}

LightAnswer light_map_of(ServerState& state, const StoredScene& scene, const LightRequest& request,
                         const RunControl& control) {
  const std::string key = request_key(request);
  if (LightMapPtr known = state.light_maps.find(scene.name, key)) return {known, true};
  if (!scene.session)
    throw_invalid("scene", "has no foliage, so there is nothing to light",
                  "a scene with trees that have leaves");
  const double needed = scene.session->plan(request).predicted_bytes;
  if (needed > static_cast<double>(state.limits.request_memory_bytes)) {
    throw Error(ErrorKind::kLimitExceeded, "request_memory_bytes",
                "the call would need about " + std::to_string(static_cast<std::uint64_t>(needed)) +
                    " bytes, one call may have " + std::to_string(state.limits.request_memory_bytes),
                "ask for fewer rays per face, fewer bands, or a closed-form method");
  }
  auto map = std::make_shared<const LightMap>(scene.session->compute(request, {}, control));
  // A deleted scene's maps would never be asked for again.
  if (state.scenes.contains(scene.name)) state.light_maps.add(scene.name, key, map);
  return {std::move(map), false};
}

}  // namespace sunfleck
