// Head comment in info_handlers.h.
#include "server/handlers/info_handlers.h"

#include "server/handlers/unary_call.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

void fill_limits(const Limits& limits, v1::Limits& message) {
  message.set_message_bytes(limits.message_bytes);
  message.set_trees_per_spec(limits.trees_per_spec);
  message.set_elements_per_scene(limits.elements_per_scene);
  message.set_scene_store_bytes(limits.scene_store_bytes);
  message.set_light_map_cache_bytes(limits.light_map_cache_bytes);
  message.set_prepared_bytes(limits.prepared_bytes);
  message.set_request_memory_bytes(limits.request_memory_bytes);
  message.set_bands(limits.bands);
  message.set_image_side_px(limits.image_side_px);
  message.set_image_samples(limits.image_samples);
  message.set_query_elements(limits.query_elements);
  message.set_running_calls(limits.running_calls);
  message.set_queued_calls(limits.queued_calls);
  message.set_default_deadline_s(limits.default_deadline_s);
  message.set_longest_deadline_s(limits.longest_deadline_s);
  message.set_stalled_write_s(limits.stalled_write_s);
  message.set_stand_sensors(limits.stand_sensors);
  message.set_stand_intervals(limits.stand_intervals);
}

void fill_load(const ServerState& state, v1::Load& message) {
  const ComputePool::Load load = state.pool.load();
  message.set_running_calls(static_cast<std::uint32_t>(load.running));
  message.set_queued_calls(static_cast<std::uint32_t>(load.queued));
  message.set_scenes(state.scenes.size());
  message.set_scene_bytes(state.scenes.bytes());
  message.set_light_maps(state.light_maps.size());
  message.set_light_map_bytes(state.light_maps.bytes());
  message.set_uptime_s(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - state.started).count());
}

}  // namespace

grpc::ServerUnaryReactor* InfoHandlers::GetServerInfo(grpc::CallbackServerContext* context,
                                                      const v1::GetServerInfoRequest*,
                                                      v1::ServerInfo* response) {
  return answer_at_once(state_, *context, "GetServerInfo", [&] {
    response->set_version(kVersion);
    response->set_build(std::string(kBuildType) + ", GCC " + __VERSION__);
    for (const std::string& method : method_names()) response->add_methods(method);
    for (const Species& species : state_.species.all()) {
      v1::SpeciesInfo& info = *response->add_species();
      info.set_code(species.code);
      info.set_latin(species.latin);
      for (const std::string& name : species.also_called) info.add_also_called(name);
    }
    fill_limits(state_.limits, *response->mutable_limits());
    fill_load(state_, *response->mutable_load());
  });
}

}  // namespace sunfleck
