// Small stands for the tests of the world grid, and the errors of an answer tree by tree.
#pragma once

#include <cmath>
#include <vector>

#include "lighting/transport/world_light.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/transport/grid_light.h"

namespace sunfleck::test {

struct StandOptions {
  int side = 5;  // trees along an edge
  int leaves = 2000;
  double spacing_m = 4.5;  // crowns are 4 m wide
  double crown_lai = 4;
  bool periodic = false;
  std::vector<CrownKind> kinds = {CrownKind::kSphere, CrownKind::kClumped, CrownKind::kCone};
  std::uint64_t seed = 3;
};

// Jittered rows of trees in any yaw, 0.85 to 1.15 of their size.
inline Forest stand(const StandOptions& o) {
  Forest forest;
  for (const CrownKind kind : o.kinds) {
    Forest one = generated_crown({.kind = kind,
                                  .leaves = o.leaves,
                                  .radius_m = 2.0,
                                  .crown_lai = o.crown_lai,
                                  .seed = o.seed + static_cast<std::uint64_t>(kind)});
    forest.materials = one.materials;
    forest.prototypes.push_back(std::move(one.prototypes[0]));
  }
  RandomStream random(o.seed, 1, RandomPurpose::kTestScene);
  for (int i = 0; i < o.side * o.side; ++i) {
    Instance instance;
    instance.position_m = {o.spacing_m * (i % o.side) + random.uniform(0, 1),
                           o.spacing_m * (i / o.side) + random.uniform(0, 1), 0.0};
    instance.prototype = {static_cast<std::uint32_t>(static_cast<std::size_t>(i) % o.kinds.size())};
    instance.yaw_rad = static_cast<float>(random.uniform(0, 6.28));
    instance.scale = static_cast<float>(random.uniform(0.85, 1.15));
    instance.tree = {static_cast<std::uint32_t>(i + 1)};
    forest.instances.push_back(instance);
  }
  if (o.periodic) {
    const double size = o.spacing_m * o.side;
    forest.period = Period{{0, 0}, {size, size}};
  }
  return forest;
}

// Sun alone and sky alone on near-infrared leaves, sky alone on visible ones.
struct StandCase {
  Forest forest;
  OpticsTable optics;
  Illumination light;
};
inline StandCase stand_case(Forest forest, double soil_albedo = 0.2) {
  for (Material& material : forest.materials)
    material.bands = {
        {"sun NIR", 0.45, 0.45, 0.3}, {"sky NIR", 0.45, 0.45, 0.3}, {"sky VIS", 0.25, 0.25, 0.1}};
  OpticsTable optics = band_optics(forest, {"sun NIR", "sky NIR", "sky VIS"}, soil_albedo);
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  light.bands = {{1000, 0}, {0, 1000}, {0, 1000}};
  return {std::move(forest), std::move(optics), std::move(light)};
}

// All trees of a world by tree_light(), as one map.
inline std::vector<BandLightMap> all_trees(const StandCase& c, const WorldLight& world,
                                           const WorldOptions& options) {
  std::vector<BandLightMap> bands(world.bands.size());
  for (std::size_t i = 0; i < c.forest.instances.size(); ++i) {
    LightMap tree = tree_light(c.forest, c.optics, world, i, options, {});
    for (std::size_t b = 0; b < bands.size(); ++b) {
      auto& elements = bands[b].elements;
      elements.insert(elements.end(), tree.bands[b].elements.begin(), tree.bands[b].elements.end());
      bands[b].trees.push_back(tree.bands[b].trees[0]);
    }
  }
  return bands;
}

inline double all_light(const ElementLight& e) {
  return static_cast<double>(e.front.total()) + e.back.total();
}
inline double diffuse_light(const ElementLight& e) {
  return all_light(e) - e.front.direct_w_m2 - e.back.direct_w_m2;
}

// Relative to the mean of `truth`.
struct StandErrors {
  double bias = 0, leaf_mean_absolute = 0, leaf_rms = 0;  // diffuse light
  double cell = 0;                                        // mean absolute in 3^3 cells of a crown, diffuse
  double direct_bias = 0;
  double tree_bias = 0, tree_rms = 0, tree_worst = 0;  // absorbed power, each tree to its own
};

inline void add_tree_errors(const std::vector<TreeLight>& own, const std::vector<TreeLight>& truth,
                            StandErrors& e) {
  double sum = 0.0, true_sum = 0.0, square = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    sum += own[i].absorbed_w;
    true_sum += truth[i].absorbed_w;
    const double off = own[i].absorbed_w / truth[i].absorbed_w - 1;
    square += off * off / static_cast<double>(own.size());
    e.tree_worst = std::max(e.tree_worst, std::abs(off));
  }
  e.tree_bias = sum / true_sum - 1;
  e.tree_rms = std::sqrt(square);
}

inline StandErrors stand_errors(const Forest& forest, const BandLightMap& own, const BandLightMap& truth) {
  StandErrors e;
  const ForestIndex index(forest);
  double sum = 0.0, true_sum = 0.0, off = 0.0, square = 0.0, cell_off = 0.0, direct = 0.0, true_direct = 0.0;
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    std::vector<double> cells(27, 0.0);
    const Prototype& p = forest.prototypes[forest.instances[i].prototype.value];
    const Box box = prototype_bounds(p);
    for (std::size_t k = 0; k < p.foliage.size(); ++k) {
      const std::size_t at = index.first_element(i) + k;
      const double a = diffuse_light(own.elements[at]), b = diffuse_light(truth.elements[at]);
      sum += a;
      true_sum += b;
      off += std::abs(a - b);
      square += (a - b) * (a - b);
      direct += all_light(own.elements[at]) - a;
      true_direct += all_light(truth.elements[at]) - b;
      const Vec3 part = 3.0 * (Vec3(p.foliage[k].centre_m) - box.lo) / box.size();
      const auto third = [](double x) { return static_cast<std::size_t>(std::min(2.0, x)); };
      cells[third(part.x) + 3 * third(part.y) + 9 * third(part.z)] += a - b;
    }
    for (const double c : cells) cell_off += std::abs(c);
  }
  const auto n = static_cast<double>(index.element_count());
  e.bias = sum / true_sum - 1;
  e.leaf_mean_absolute = off / true_sum;
  e.leaf_rms = std::sqrt(square / n) / (true_sum / n);
  e.cell = cell_off / true_sum;
  e.direct_bias = true_direct > 0.0 ? direct / true_direct - 1 : 0.0;
  add_tree_errors(own.trees, truth.trees, e);
  return e;
}

}  // namespace sunfleck::test
