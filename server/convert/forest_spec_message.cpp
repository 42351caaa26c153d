// Head comment in forest_spec_message.h. Ranges here are what the service accepts; sim checks what must hold
// between the fields when it grows the forest.
#include "server/convert/forest_spec_message.h"

#include <algorithm>
#include <map>
#include <set>

#include "server/convert/crowns_message.h"
#include "server/convert/surroundings_message.h"
#include "sim/base/error.h"
#include "sunfleck/v1/scene.pb.h"

namespace sunfleck {
namespace {

constexpr double kFarthest_m = 1e6, kTallest_m = 200, kWidest_m = 100, kThickest_cm = 2000;

// Looks each name up once; unknown ones become violations that list what is known.
class SpeciesCheck {
 public:
  SpeciesCheck(const SpeciesLibrary& library, Violations& violations)
      : library_(library), violations_(violations) {}

  void operator()(const std::string& field, const std::string& name) {
    if (!violations_.text(field, name, 200)) return;
    const auto [entry, is_new] = problems_.try_emplace(name);
    if (is_new) entry->second = problem_of(name);
    if (!entry->second.empty()) violations_.add(field, entry->second);
  }

 private:
  std::string problem_of(const std::string& name) const {
    try {
      library_.find(name, "species");
      return {};
    } catch (const Error& error) {
      return error.problem() + (error.remedy().empty() ? "" : " (" + error.remedy() + ")");
    }
  }

  const SpeciesLibrary& library_;
  Violations& violations_;
  std::map<std::string, std::string> problems_;
};

TreeForm form_from_message(v1::TreeForm form, const std::string& field, Violations& violations) {
  switch (form) {
    case v1::TREE_FORM_UNSPECIFIED:
    case v1::TREE_FORM_STAND:
      return TreeForm::kStandGrown;
    case v1::TREE_FORM_OPEN:
      return TreeForm::kOpenGrown;
    default:
      break;
  }
  violations.add(field, "unknown form " + std::to_string(form));
  return TreeForm::kStandGrown;
}

InventoryTree tree_from_message(const v1::InventoryTree& message, const std::string& field,
                                Violations& violations) {
  InventoryTree tree;
  tree.id = TreeId{message.id_tree()};
  tree.species = message.species();
  tree.x_m = message.x_m();
  tree.y_m = message.y_m();
  tree.dbh_cm = message.dbh_cm();
  tree.form = form_from_message(message.form(), field + ".form", violations);
  violations.number(field + ".x_m", tree.x_m, -kFarthest_m, kFarthest_m);
  violations.number(field + ".y_m", tree.y_m, -kFarthest_m, kFarthest_m);
  violations.above(field + ".dbh_cm", tree.dbh_cm, 0, kThickest_cm);
  const auto copy = [&](bool given, double value, const char* name, double hi, std::optional<double>& to) {
    if (!given) return;
    to = value;
    violations.number(field + "." + name, value, 0, hi);
  };
  copy(message.has_height_m(), message.height_m(), "height_m", kTallest_m, tree.height_m);
  copy(message.has_crown_base_m(), message.crown_base_m(), "crown_base_m", kTallest_m, tree.crown_base_m);
  copy(message.has_widest_m(), message.widest_m(), "widest_m", kTallest_m, tree.widest_m);
  copy(message.has_radius_n_m(), message.radius_n_m(), "radius_n_m", kWidest_m, tree.radius_n_m);
  copy(message.has_radius_s_m(), message.radius_s_m(), "radius_s_m", kWidest_m, tree.radius_s_m);
  copy(message.has_radius_e_m(), message.radius_e_m(), "radius_e_m", kWidest_m, tree.radius_e_m);
  copy(message.has_radius_w_m(), message.radius_w_m(), "radius_w_m", kWidest_m, tree.radius_w_m);
  copy(message.has_leaf_area_density_per_m(), message.leaf_area_density_per_m(), "leaf_area_density_per_m",
       1000, tree.leaf_area_density_per_m);
  if (tree.height_m && tree.crown_base_m && *tree.crown_base_m >= *tree.height_m) {
    violations.add(field + ".crown_base_m", "must be below height_m");
  }
  return tree;
}

PlantingPattern pattern_from_message(v1::PlantingPattern pattern, const std::string& field,
                                     Violations& violations) {
  switch (pattern) {
    case v1::PLANTING_PATTERN_UNSPECIFIED:
    case v1::PLANTING_PATTERN_POISSON_DISC:
      return PlantingPattern::kPoissonDisc;
    case v1::PLANTING_PATTERN_ROWS:
      return PlantingPattern::kRows;
    case v1::PLANTING_PATTERN_RANDOM:
      return PlantingPattern::kRandom;
    default:
      break;
  }
  violations.add(field, "unknown pattern " + std::to_string(pattern));
  return PlantingPattern::kPoissonDisc;
}

PlantingRule rule_from_message(const v1::PlantingRule& message, const std::string& field,
                               const Limits& limits, Violations& violations) {
  PlantingRule rule;
  rule.species = message.species();
  rule.pattern = pattern_from_message(message.pattern(), field + ".pattern", violations);
  rule.form = form_from_message(message.form(), field + ".form", violations);
  if (message.has_count()) rule.count = message.count();
  if (message.has_spacing_m()) rule.spacing_m = message.spacing_m();
  if (message.has_dbh_mean_cm()) rule.dbh_mean_cm = message.dbh_mean_cm();
  if (message.has_dbh_sd_cm()) rule.dbh_sd_cm = message.dbh_sd_cm();
  violations.integer(field + ".count", rule.count, 1, static_cast<std::int64_t>(limits.trees_per_spec));
  violations.number(field + ".spacing_m", rule.spacing_m, 0.01, 1000);
  violations.above(field + ".dbh_mean_cm", rule.dbh_mean_cm, 0, kThickest_cm);
  violations.number(field + ".dbh_sd_cm", rule.dbh_sd_cm, 0, kThickest_cm);
  return rule;
}

TreeSource source_from_message(v1::TreeSource source, const std::string& field, Violations& violations) {
  switch (source) {
    case v1::TREE_SOURCE_UNSPECIFIED:
    case v1::TREE_SOURCE_LSYSTEM:
      return TreeSource::kLsystem;
    case v1::TREE_SOURCE_CROWN:
      return TreeSource::kCrown;
    default:
      break;
  }
  violations.add(field, "unknown tree source " + std::to_string(source));
  return TreeSource::kLsystem;
}

void read_inventory_rows(const v1::ForestSpec& message, const std::string& field, SpeciesCheck& known,
                         Violations& violations, ForestSpec& spec) {
  std::set<std::uint32_t> ids;
  for (int i = 0; i < message.inventory_size(); ++i) {
    const std::string row = at(field + ".inventory", static_cast<std::size_t>(i));
    spec.inventory.push_back(tree_from_message(message.inventory(i), row, violations));
    known(row + ".species", message.inventory(i).species());
    if (!ids.insert(message.inventory(i).id_tree()).second) {
      violations.add(row + ".id_tree", "must be unique, " + std::to_string(message.inventory(i).id_tree()) +
                                           " was there before");
    }
  }
}

// Where the trees come from, and how many they are at most.
std::uint64_t read_trees(const v1::ForestSpec& message, const std::string& field, const Limits& limits,
                         SpeciesCheck& known, Violations& violations, ForestSpec& spec) {
  read_inventory_rows(message, field, known, violations, spec);
  std::uint64_t trees = spec.inventory.size();
  for (int i = 0; i < message.planting_size(); ++i) {
    const std::string row = at(field + ".planting", static_cast<std::size_t>(i));
    spec.planting.push_back(rule_from_message(message.planting(i), row, limits, violations));
    known(row + ".species", message.planting(i).species());
    trees += static_cast<std::uint64_t>(std::max(0, spec.planting.back().count));
  }
  const bool one_of_both = spec.inventory.empty() != spec.planting.empty();
  if (!one_of_both) violations.add(field, "must have either `inventory` or `planting`");
  if (trees > limits.trees_per_spec) {
    violations.add(field + (spec.planting.empty() ? ".inventory" : ".planting"),
                   "must have at most " + std::to_string(limits.trees_per_spec) + " trees in all, got " +
                       std::to_string(trees));
  }
  return trees;
}

void read_plot(const v1::ForestSpec& message, const std::string& field, Violations& violations,
               ForestSpec& spec) {
  spec.plot_width_m = message.plot_width_m();
  spec.plot_depth_m = message.plot_depth_m();
  const double least_m = spec.planting.empty() ? 0 : 0.01;
  violations.number(field + ".plot_width_m", spec.plot_width_m, least_m, kFarthest_m);
  violations.number(field + ".plot_depth_m", spec.plot_depth_m, least_m, kFarthest_m);
  spec.terrain = {message.terrain().elevation_m(), message.terrain().slope_rad(),
                  message.terrain().aspect_rad()};
  violations.number(field + ".terrain.elevation_m", spec.terrain.elevation_m, -1e4, 1e4);
  violations.number(field + ".terrain.slope_rad", spec.terrain.slope_rad, 0, radians_from_degrees(80));
  violations.number(field + ".terrain.aspect_rad", spec.terrain.aspect_rad, -2 * kPi, 2 * kPi);
  if (!message.has_period()) return;
  const v1::Period& period = message.period();
  spec.period = Period{{period.origin_x_m(), period.origin_y_m()}, {period.size_x_m(), period.size_y_m()}};
  violations.number(field + ".period.origin_x_m", period.origin_x_m(), -kFarthest_m, kFarthest_m);
  violations.number(field + ".period.origin_y_m", period.origin_y_m(), -kFarthest_m, kFarthest_m);
  violations.number(field + ".period.size_x_m", period.size_x_m(), 0.01, kFarthest_m);
  violations.number(field + ".period.size_y_m", period.size_y_m(), 0.01, kFarthest_m);
}

void read_growth(const v1::ForestSpec& message, const std::string& field, Violations& violations,
                 ForestSpec& spec) {
  if (!message.has_grow_in_light()) return;
  const v1::GrowInLight& growth = message.grow_in_light();
  GrowInLight& asked = spec.grow_in_light.emplace();
  if (growth.has_years()) asked.years = growth.years();
  asked.stop_height_m = growth.stop_height_m();
  if (growth.has_cell_m()) asked.cell_m = growth.cell_m();
  violations.integer(field + ".years", asked.years, 1, 200);
  violations.number(field + ".stop_height_m", asked.stop_height_m, 0, 100);
  violations.number(field + ".cell_m", asked.cell_m, 0.1, 5);
  if (growth.light() == v1::GROWTH_LIGHT_GRID)
    asked.light = GrowthLight::kGrid;
  else if (growth.light() != v1::GROWTH_LIGHT_UNSPECIFIED && growth.light() != v1::GROWTH_LIGHT_OPENNESS)
    violations.add(field + ".light", "unknown light " + std::to_string(growth.light()));
}

// How trees become geometry.
void read_detail(const v1::ForestSpec& message, const std::string& field, std::uint64_t trees,
                 const Limits& limits, Violations& violations, ForestSpec& spec) {
  spec.trees = source_from_message(message.trees(), field + ".trees", violations);
  if (message.has_elements_per_tree()) spec.elements_per_tree = message.elements_per_tree();
  if (message.has_detail()) spec.detail = message.detail();
  if (message.has_size_classes()) spec.size_classes = message.size_classes();
  if (message.has_variants()) spec.variants = message.variants();
  const bool in_range =
      violations.integer(field + ".elements_per_tree", spec.elements_per_tree, 1, 10'000'000);
  violations.above(field + ".detail", spec.detail, 0, 1);
  violations.integer(field + ".size_classes", spec.size_classes, 1, 64);
  violations.integer(field + ".variants", spec.variants, 1, 64);
  read_growth(message, field + ".grow_in_light", violations, spec);
  read_crowns(message, field, violations, spec);
  if (spec.trees != TreeSource::kCrown || !in_range) return;
  const double elements = predicted_crown_elements(spec, trees);
  if (elements > static_cast<double>(limits.elements_per_scene)) {
    const char* key = spec.element_area_m2 > 0 ? ".element_area_m2" : ".elements_per_tree";
    violations.add(field + key, "must keep trees times elements within " +
                                    std::to_string(limits.elements_per_scene) + ", got " +
                                    std::to_string(static_cast<std::uint64_t>(std::min(elements, 1e18))));
  }
}

}  // namespace

ForestSpec forest_spec_from_message(const v1::ForestSpec& message, const std::string& field,
                                    const SpeciesLibrary& species, const Limits& limits,
                                    Violations& violations) {
  ForestSpec spec;
  if (!message.name().empty()) spec.name = message.name();
  violations.text(field + ".name", spec.name, 200);
  if (message.has_seed()) spec.seed = message.seed();
  SpeciesCheck known(species, violations);
  const std::uint64_t trees = read_trees(message, field, limits, known, violations, spec);
  read_detail(message, field, trees, limits, violations, spec);
  read_plot(message, field, violations, spec);
  read_surroundings(message, field, trees, limits, violations, spec);
  return spec;
}

}  // namespace sunfleck
