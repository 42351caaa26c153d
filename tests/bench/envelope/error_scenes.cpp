// See error_scenes.h.
#include "tests/bench/envelope/error_scenes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sim/forest/generated_scenes.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck::bench {

namespace {

Forest crown(CrownKind kind, int leaves, double lai) {
  return generated_crown({.kind = kind, .leaves = leaves, .crown_lai = lai, .seed = 5});
}

// Every normal turned half of the way up.
Forest planophile(Forest forest) {
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    const double half = glm::length(Vec3(e.half_u_m));
    Vec3 normal = glm::normalize(glm::cross(Vec3(e.half_u_m), Vec3(e.half_v_m)));
    if (normal.z < 0) normal = -normal;
    const Basis basis = basis_around(glm::normalize(normal + Vec3(0, 0, 1)));
    e.half_u_m = Vec3f(half * basis.tangent);
    e.half_v_m = Vec3f(half * basis.bitangent);
  }
  return forest;
}

Forest beech(int leaves) {
  const Species species =
      load_species(std::filesystem::path(SUNFLECK_SOURCE_DIR) / "configs/species/fagus_sylvatica.toml");
  const TreeSize size = expected_size(species, 30);
  const double detail = std::min(1.0, leaves / 40000.0);
  Forest forest;
  forest.materials = {species.material};
  forest.prototypes.push_back(grow_prototype(species, size, 1, detail));
  forest.instances.push_back({});
  return forest;
}

// Nine crowns of radius 1 in a square of 6 m that repeats, each turned its own way.
Forest stand(int leaves) {
  Forest forest = crown(CrownKind::kSphere, std::max(1, leaves / 9), 3);
  forest.instances.clear();
  for (int i = 0; i < 9; ++i) {
    Instance instance;
    instance.position_m = Vec3(1.0 + 2.0 * (i % 3), 1.0 + 2.0 * (i / 3), 0.0);
    instance.yaw_rad = 0.7f * static_cast<float>(i);
    forest.instances.push_back(instance);
  }
  forest.period = Period{.origin_m = {0, 0}, .size_m = {6, 6}};
  return forest;
}

}  // namespace

std::vector<ErrorScene> error_scenes() {
  return {{"sphere LAI 1", [](int n) { return crown(CrownKind::kSphere, n, 1); }},
          {"sphere LAI 2", [](int n) { return crown(CrownKind::kSphere, n, 2); }},
          {"sphere LAI 5", [](int n) { return crown(CrownKind::kSphere, n, 5); }},
          {"sphere LAI 8", [](int n) { return crown(CrownKind::kSphere, n, 8); }},
          {"clumped LAI 5", [](int n) { return crown(CrownKind::kClumped, n, 5); }},
          {"cone LAI 5", [](int n) { return crown(CrownKind::kCone, n, 5); }},
          {"planophile cone LAI 5", [](int n) { return planophile(crown(CrownKind::kCone, n, 5)); }},
          {"beech", beech},
          {"periodic stand", stand},
          {"periodic layer LAI 3", [](int n) {
             return generated_layer({.lai = 3, .cell_m = 1, .height_m = 1, .leaves = n, .seed = 3});
           }}};
}

std::vector<std::size_t> cells_of_elements(const Forest& forest) {
  const ForestIndex index(forest);
  const Box box = forest_bounds(forest);
  std::vector<std::size_t> cells(index.element_count());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto place = index.place(i);
    const Vec3 share = (world_element(forest, place.instance, place.local).centre_m - box.lo) / box.size();
    for (int axis = 0; axis < 3; ++axis)
      cells[i] = cells[i] * 4 + static_cast<std::size_t>(std::clamp(static_cast<int>(share[axis] * 4), 0, 3));
  }
  return cells;
}

}  // namespace sunfleck::bench
