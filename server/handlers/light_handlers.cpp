// Head comment in light_handlers.h.
#include "server/handlers/light_handlers.h"

#include "server/convert/light_map_message.h"
#include "server/convert/light_query.h"
#include "server/convert/light_selection_message.h"
#include "server/convert/light_spec_message.h"
#include "server/handlers/array_stream.h"
#include "server/handlers/unary_call.h"

namespace sunfleck {
namespace {

using LightMapCall = StreamCall<v1::StreamLightMapResponse>;

// The trees the answer is for; refuses those that the scene does not have.
Forest chosen_of(const Forest& forest, const Selection& selection) {
  Violations violations;
  check_selection(selection, forest, "light", violations);
  violations.refuse_if_any();
  return selected_forest(forest, selection);
}

// What is sent before the computation begins.
v1::StreamLightMapResponse header_of(const StoredScene& scene, const LightRequest& request) {
  v1::StreamLightMapResponse message;
  v1::LightMapHeader& header = *message.mutable_header();
  header.set_scene(scene.name);
  header.set_method(to_string(request.method));
  for (const std::string& band : request.optics.bands) header.add_bands(band);
  header.set_element_count(scene.elements);
  header.set_tree_count(scene.forest.instances.size());
  if (request.selection.everything()) return message;
  const Forest chosen = chosen_of(scene.forest, request.selection);
  header.set_element_count(ForestIndex(chosen).element_count());
  header.set_tree_count(chosen.instances.size());
  return message;
}

LightMapCall::Next arrays_then_summary(const LightAnswer& answer) {
  auto arrays = std::make_shared<const LightMapArrays>(answer.map);
  return arrays_then<v1::StreamLightMapResponse>(
      arrays, arrays->views(), &v1::StreamLightMapResponse::mutable_array,
      [answer, arrays](v1::StreamLightMapResponse& message) {
        fill_summary(*answer.map, *arrays, *message.mutable_summary());
        message.mutable_summary()->set_from_cache(answer.from_cache);
      });
}

}  // namespace

grpc::ServerUnaryReactor* LightHandlers::QueryLight(grpc::CallbackServerContext* context,
                                                    const v1::QueryLightRequest* request,
                                                    v1::QueryLightResponse* response) {
  return compute_unary(state_, *context, "QueryLight", [this, request, response](const RunControl& control) {
    Violations violations;
    const LightRequest light =
        light_request_from_message(request->light(), "light", state_.limits, violations);
    check_query_size(*request, state_.limits, violations);
    violations.refuse_if_any();
    const ScenePtr scene = state_.scenes.find(request->scene());
    if (light.selection.everything())
      check_query_places(*request, scene->forest, violations);
    else
      check_query_places(*request, chosen_of(scene->forest, light.selection), violations);
    violations.refuse_if_any();
    fill_answer(*request, *light_map_of(state_, *scene, light, control).map, *response);
  });
}

grpc::ServerWriteReactor<v1::StreamLightMapResponse>* LightHandlers::StreamLightMap(
    grpc::CallbackServerContext* context, const v1::StreamLightMapRequest* request) {
  return LightMapCall::start(
      state_, *context, "StreamLightMap", [this, request](LightMapCall& call, const RunControl& control) {
        Violations violations;
        const LightRequest light =
            light_request_from_message(request->light(), "light", state_.limits, violations);
        violations.refuse_if_any();
        const ScenePtr scene = state_.scenes.find(request->scene());
        call.push(header_of(*scene, light));
        return arrays_then_summary(light_map_of(state_, *scene, light, control));
      });
}

}  // namespace sunfleck
