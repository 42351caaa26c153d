// ForestSpec::grow_in_light. Every tree has its own seed and turn, drawn from the forest's seed and its
// number, so that the order of the table does not matter.
#include <algorithm>
#include <cstdio>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/stand.h"
#include "sim/forest/tree_size.h"

namespace sunfleck {
namespace {

constexpr std::uint64_t kSeedling = 79;  // names the stream

void require_grammars(const std::vector<StandTree>& stand) {
  for (const StandTree& entry : stand)
    if (entry.species->grammar_in_light.empty())
      throw_invalid(tree_label(entry.tree), entry.species->latin + " has no grammar that grows in light",
                    "Fagus sylvatica or Quercus robur, or leave [forest.grow_in_light] out");
}

void require_spec(const ForestSpec& spec, const GrowthLightMaker& grid_light) {
  if (spec.terrain.slope_rad != 0)
    throw_invalid("forest.terrain.slope_deg", "trees that grow in light stand on level ground", "0");
  if (spec.detail != 1.0)
    throw_invalid("forest.detail", "is for trees grown to a size", "1, with [forest.grow_in_light]");
  if (spec.leaf_area_factor != 1.0)
    throw_invalid("forest.leaf_area_factor", "is for trees grown to a size",
                  "1, with [forest.grow_in_light]");
  if (spec.grow_in_light->light == GrowthLight::kGrid && !grid_light)
    throw_invalid("forest.grow_in_light.light", "nobody here answers with the light of the grid",
                  "light = \"openness\"");
}

std::vector<Seedling> seedlings_of(const ForestSpec& spec, const std::vector<StandTree>& stand) {
  std::vector<Seedling> seedlings;
  for (const StandTree& entry : stand) {
    const std::uint64_t seed = mix_seed(mix_seed(spec.seed, kSeedling), entry.tree.id.value);
    RandomStream random(seed, 0, RandomPurpose::kPlanting);
    const double yaw_rad = static_cast<double>(static_cast<float>(random.uniform(0.0, 2.0 * kPi)));
    seedlings.push_back(
        {entry.species, entry.species->grammar_in_light, {entry.tree.x_m, entry.tree.y_m}, yaw_rad, seed});
  }
  return seedlings;
}

struct Spread {
  double lo = INFINITY, hi = -INFINITY;
  void take(double x) { lo = std::min(lo, x), hi = std::max(hi, x); }
};

std::string note_of(const std::vector<Prototype>& trees, int years) {
  Spread height_m, base_m, dbh_cm;
  for (const Prototype& tree : trees) {
    const TreeMeasures m = measure(tree);
    height_m.take(m.height_m), base_m.take(m.crown_base_m), dbh_cm.take(100 * m.dbh_m);
  }
  char text[300];
  std::snprintf(text, sizeof text,
                "%zu trees grew %d years in light: heights %.1f to %.1f m, crown bases %.1f to %.1f m, "
                "diameters %.1f to %.1f cm; stated sizes were not used",
                trees.size(), years, height_m.lo, height_m.hi, base_m.lo, base_m.hi, dbh_cm.lo, dbh_cm.hi);
  return text;
}

}  // namespace

void grow_stand_in_light(const ForestSpec& spec, const std::vector<StandTree>& stand,
                         const GrowthLightMaker& grid_light, const RunControl& control, Forest& forest,
                         std::vector<std::string>& notes) {
  require_spec(spec, grid_light);
  require_grammars(stand);
  const GrowInLight& asked = *spec.grow_in_light;
  const std::vector<Seedling> seedlings = seedlings_of(spec, stand);
  std::optional<Vec2> period_m;
  if (forest.period) period_m = forest.period->size_m;
  GrowthSite site = site_of(seedlings, period_m, asked.years);
  site.cell_m = asked.cell_m;
  GrowthOptions options;
  options.years = asked.years;
  options.stop_height_m = asked.stop_height_m;
  const BudLight light = asked.light == GrowthLight::kGrid ? grid_light(site, control) : openness_light(site);
  GrownStand grown = grow_together(seedlings, site, light, options, control);
  for (std::size_t i = 0; i < stand.size(); ++i) {
    if (grown.trees[i].foliage.empty()) continue;  // it died
    grown.trees[i].name = stand[i].species->latin + " " + std::to_string(stand[i].tree.id.value);
    forest.instances.push_back({stem_foot_m(forest.terrain, stand[i].tree),
                                {static_cast<std::uint32_t>(forest.prototypes.size())},
                                static_cast<float>(seedlings[i].yaw_rad),
                                1.0f,
                                stand[i].tree.id});
    forest.prototypes.push_back(std::move(grown.trees[i]));
  }
  if (forest.instances.empty())
    throw_invalid("forest.grow_in_light", "no tree lived", "more room, or fewer years");
  notes.push_back(note_of(forest.prototypes, grown.years));
  if (const std::size_t dead = stand.size() - forest.instances.size(); dead > 0)
    notes.push_back(std::to_string(dead) + " of " + std::to_string(stand.size()) +
                    " trees died for want of light and room");
}

}  // namespace sunfleck
