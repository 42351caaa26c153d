// A forest and a light map for file tests: every number random bits of a seed, so that a mixed-up variable
// or band shows.
#pragma once

#include "lighting/base/light_map.h"
#include "sim/base/random.h"
#include "sim/forest/forest.h"

namespace sunfleck::test {

inline FoliageElement square_leaf(const Vec3f& centre_m, float half_m) {
  FoliageElement leaf;
  leaf.centre_m = centre_m;
  leaf.half_u_m = {half_m, 0, 0};
  leaf.half_v_m = {0, half_m, 0};
  leaf.area_m2 = 4 * half_m * half_m;
  return leaf;
}

// `trees` instances of one prototype with `leaves_per_tree` leaves, plus one of a prototype without foliage.
inline Forest example_forest(std::size_t trees, std::size_t leaves_per_tree) {
  Forest forest;
  forest.name = "example";
  forest.materials = {{"Fagus sylvatica", {{"PAR", 0.1, 0.05, 0.2}}}};
  Prototype tree;
  tree.name = "tree";
  tree.materials = {"Fagus sylvatica"};
  Prototype bare = tree;
  RandomStream random(1, 0, RandomPurpose::kTestScene);
  const auto number = [&] { return static_cast<float>(random.uniform(-3, 3)); };
  for (std::size_t i = 0; i < leaves_per_tree; ++i)
    tree.foliage.push_back(square_leaf({number(), number(), number()}, 0.03f));
  forest.prototypes = {tree, bare};
  for (std::size_t t = 0; t < trees; ++t) {
    Instance instance;
    instance.position_m = {7.1 * static_cast<double>(t), 1e5 / 3, 0.7};
    instance.yaw_rad = 0.5f * static_cast<float>(t);
    instance.scale = 1.25f;
    instance.tree = TreeId{4000000000u + static_cast<std::uint32_t>(t)};
    forest.instances.push_back(instance);
  }
  if (trees > 0) forest.instances.push_back({Vec3(1, 2, 3), PrototypeId{1}, 0, 1, TreeId{7}});
  return forest;
}

inline BandLightMap example_band(const Forest& forest, const std::string& name, std::uint64_t seed) {
  const ForestIndex index(forest);
  RandomStream random(seed, 1, RandomPurpose::kTestScene);
  const auto f = [&] { return static_cast<float>(random.uniform() / 3.0); };
  BandLightMap band;
  band.band = name;
  for (std::size_t i = 0; i < index.element_count(); ++i)
    band.elements.push_back({{f(), f(), f()}, {f(), f(), f()}, f()});
  for (std::uint32_t t = 0; t < forest.instances.size(); ++t)
    band.trees.push_back({forest.instances[t].tree, t, 1.0 / 3 + t, 1.0 / 7 + t, random.uniform() / 3,
                          random.uniform() / 3, random.uniform() / 3});
  band.budget = {random.uniform() / 3, random.uniform() / 3, random.uniform() / 3, random.uniform() / 3,
                 random.uniform() / 3, random.uniform() / 3, random.uniform() / 3};
  band.has_budget = true;
  band.mean_irradiance_w_m2 = random.uniform() / 3;
  band.mean_irradiance_standard_error_w_m2 = random.uniform() / 3;
  return band;
}

// PAR with standard errors and a budget, NIR with neither.
inline LightMap example_map(const Forest& forest) {
  LightMap map;
  map.bands = {example_band(forest, "PAR", 11), example_band(forest, "NIR, near", 12)};
  RandomStream random(13, 1, RandomPurpose::kTestScene);
  for (std::size_t i = 0; i < ForestIndex(forest).element_count(); ++i) {
    map.sunlit_fraction.push_back(static_cast<float>(random.uniform()));
    map.bands[0].standard_error_w_m2.push_back(static_cast<float>(random.uniform() / 3));
  }
  map.bands[1].has_budget = false;
  map.provenance = {.method = "reference",
                    .version = "0.1.0",
                    .forest_hash = "abc123",
                    .seed = 0xFEDCBA9876543210u,
                    .settings = {{"rays_per_face", "64"}, {"note", "quote \" and \\ and \n"}, {"empty", ""}},
                    .skipped = {{"sun", "below the horizon", 1.0 / 3}},
                    .notes = {"first", ""},
                    .times = {{"trace", 1.0 / 3, 0.1}}};
  return map;
}

}  // namespace sunfleck::test
