// Head comment in scene_store.h.
#include "server/jobs/scene_store.h"

#include "server/convert/violations.h"

namespace sunfleck {
namespace {

std::uint64_t forest_bytes(const Forest& forest) {
  std::uint64_t sum = sizeof(StoredScene) + forest.instances.size() * sizeof(Instance);
  for (const Prototype& prototype : forest.prototypes) {
    sum += prototype.foliage.size() * sizeof(FoliageElement) + prototype.wood.size() * sizeof(WoodSegment) +
           prototype.wood_mesh.size() * sizeof(WoodTriangle) + sizeof(Prototype);
  }
  return sum;
}

}  // namespace

UnknownScene::UnknownScene(const std::string& name)
    : Error(ErrorKind::kNotFound, "scene '" + clipped(name) + "'", "no such scene",
            "ListScenes tells what there is; CreateScene makes one") {}

ScenePtr make_scene(Forest forest, std::uint64_t seed, const std::shared_ptr<PreparedCache>& prepared) {
  auto scene = std::make_shared<StoredScene>();
  scene->name = "scenes/" + content_hash(forest);
  scene->forest = std::move(forest);
  scene->seed = seed;
  scene->elements = ForestIndex(scene->forest).element_count();
  scene->leaf_area_m2 = forest_leaf_area_m2(scene->forest);
  scene->bounds = forest_bounds(scene->forest);
  scene->memory_bytes = forest_bytes(scene->forest);
  scene->created = std::chrono::system_clock::now();
  if (scene->elements > 0) scene->session = std::make_unique<const LightSession>(scene->forest, prepared);
  return scene;
}

ScenePtr SceneStore::add(ScenePtr scene) {
  const std::lock_guard lock(mutex_);
  if (const auto known = scenes_.find(scene->name); known != scenes_.end()) return known->second;
  if (bytes_ + scene->memory_bytes > budget_bytes_) {
    throw Error(ErrorKind::kLimitExceeded, "scene store",
                "the scene needs " + std::to_string(scene->memory_bytes) + " bytes, " +
                    std::to_string(budget_bytes_ - bytes_) + " of " + std::to_string(budget_bytes_) +
                    " are free",
                "delete scenes you no longer need, or ask for fewer trees or elements");
  }
  bytes_ += scene->memory_bytes;
  return scenes_.emplace(scene->name, std::move(scene)).first->second;
}

ScenePtr SceneStore::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto scene = scenes_.find(name);
  if (scene == scenes_.end()) throw UnknownScene(name);
  return scene->second;
}

bool SceneStore::contains(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return scenes_.contains(name);
}

void SceneStore::remove(const std::string& name) {
  ScenePtr gone;  // freed after the lock
  const std::lock_guard lock(mutex_);
  const auto scene = scenes_.find(name);
  if (scene == scenes_.end()) throw UnknownScene(name);
  gone = std::move(scene->second);
  bytes_ -= gone->memory_bytes;
  scenes_.erase(scene);
}

std::vector<ScenePtr> SceneStore::list(const std::string& after, std::size_t count) const {
  const std::lock_guard lock(mutex_);
  std::vector<ScenePtr> page;
  for (auto it = scenes_.upper_bound(after); it != scenes_.end() && page.size() < count; ++it) {
    page.push_back(it->second);
  }
  return page;
}

std::size_t SceneStore::size() const {
  const std::lock_guard lock(mutex_);
  return scenes_.size();
}

std::uint64_t SceneStore::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace sunfleck
