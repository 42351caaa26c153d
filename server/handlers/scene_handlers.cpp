// Head comment in scene_handlers.h.
#include "server/handlers/scene_handlers.h"

#include "lighting/plan/growth_light.h"
#include "server/convert/forest_spec_message.h"
#include "server/handlers/unary_call.h"
#include "sim/base/error.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

void fill_vector(const Vec3& from, v1::Vector3& to) {
  to.set_x(from.x);
  to.set_y(from.y);
  to.set_z(from.z);
}

void fill_scene(const StoredScene& scene, v1::Scene& message) {
  message.set_name(scene.name);
  message.set_forest_name(scene.forest.name);
  message.set_tree_count(scene.forest.instances.size());
  message.set_element_count(scene.elements);
  message.set_prototype_count(scene.forest.prototypes.size());
  message.set_leaf_area_m2(scene.leaf_area_m2);
  if (!scene.bounds.empty()) {
    fill_vector(scene.bounds.lo, *message.mutable_bounds_lo_m());
    fill_vector(scene.bounds.hi, *message.mutable_bounds_hi_m());
  }
  message.set_memory_bytes(scene.memory_bytes);
  message.mutable_create_time()->set_seconds(std::chrono::system_clock::to_time_t(scene.created));
  message.set_seed(scene.seed);
  message.set_version(kVersion);
}

void check_size(const StoredScene& scene, const Limits& limits) {
  if (scene.elements <= limits.elements_per_scene) return;
  throw Error(ErrorKind::kLimitExceeded, "elements_per_scene",
              "the forest has " + std::to_string(scene.elements) + " foliage elements, at most " +
                  std::to_string(limits.elements_per_scene) + " are allowed",
              "ask for fewer trees or less detail");
}

// 1 .. 1000; 0 means 50.
std::size_t checked_page_size(std::int32_t asked) {
  Violations violations;
  violations.integer("page_size", asked, 0, 1000);
  violations.refuse_if_any();
  return asked == 0 ? 50 : static_cast<std::size_t>(asked);
}

}  // namespace

grpc::ServerUnaryReactor* SceneHandlers::CreateScene(grpc::CallbackServerContext* context,
                                                     const v1::CreateSceneRequest* request,
                                                     v1::Scene* response) {
  return compute_unary(state_, *context, "CreateScene", [this, request, response](const RunControl& control) {
    Violations violations;
    const ForestSpec spec =
        forest_spec_from_message(request->spec(), "spec", state_.species, state_.limits, violations);
    violations.refuse_if_any();
    const ScenePtr scene =
        make_scene(grow_lit_forest(spec, state_.species, control), spec.seed, state_.prepared);
    check_size(*scene, state_.limits);
    fill_scene(*state_.scenes.add(scene), *response);
  });
}

grpc::ServerUnaryReactor* SceneHandlers::GetScene(grpc::CallbackServerContext* context,
                                                  const v1::GetSceneRequest* request, v1::Scene* response) {
  return answer_at_once(state_, *context, "GetScene",
                        [&] { fill_scene(*state_.scenes.find(request->name()), *response); });
}

grpc::ServerUnaryReactor* SceneHandlers::ListScenes(grpc::CallbackServerContext* context,
                                                    const v1::ListScenesRequest* request,
                                                    v1::ListScenesResponse* response) {
  return answer_at_once(state_, *context, "ListScenes", [&] {
    const std::size_t size = checked_page_size(request->page_size());
    const std::vector<ScenePtr> scenes = state_.scenes.list(request->page_token(), size + 1);
    for (std::size_t i = 0; i < std::min(size, scenes.size()); ++i) {
      fill_scene(*scenes[i], *response->add_scenes());
    }
    if (scenes.size() > size) response->set_next_page_token(scenes[size - 1]->name);
  });
}

grpc::ServerUnaryReactor* SceneHandlers::DeleteScene(grpc::CallbackServerContext* context,
                                                     const v1::DeleteSceneRequest* request,
                                                     v1::DeleteSceneResponse*) {
  return answer_at_once(state_, *context, "DeleteScene", [&] {
    state_.scenes.remove(request->name());
    state_.light_maps.forget_scene(request->name());
  });
}

}  // namespace sunfleck
