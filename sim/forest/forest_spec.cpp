// The [forest] table of a scene file, key by key. Every number has its range here; the functions that use the
// values check again what only they know.

#include "sim/forest/forest_spec.h"

#include "sim/base/error.h"
#include "sim/forest/realism.h"
#include "sim/forest/surroundings.h"

namespace sunfleck {

namespace {

constexpr double kFarM = 1e7;

PlantingPattern pattern_of(const ConfigTable& table) {
  const std::string name = table.choice_or("pattern", "poisson_disc", {"poisson_disc", "rows", "random"});
  if (name == "rows") return PlantingPattern::kRows;
  if (name == "random") return PlantingPattern::kRandom;
  return PlantingPattern::kPoissonDisc;
}

TreeForm form_or(const ConfigTable& table, TreeForm usual) {
  const std::string word = table.choice_or("form", to_string(usual), {"stand", "open"});
  return word == to_string(TreeForm::kOpenGrown) ? TreeForm::kOpenGrown : TreeForm::kStandGrown;
}

GrowInLight grow_in_light_of(const ConfigTable& table) {
  GrowInLight growth;
  growth.years = static_cast<int>(table.integer_or("years", growth.years, {1, 200}));
  growth.stop_height_m = table.number_or("stop_height_m", growth.stop_height_m, {0, 100});
  growth.cell_m = table.number_or("cell_m", growth.cell_m, {0.1, 5});
  if (table.choice_or("light", "openness", {"openness", "grid"}) == "grid") growth.light = GrowthLight::kGrid;
  return growth;
}

PlantingRule planting_rule(const ConfigTable& table, TreeForm usual_form) {
  PlantingRule rule;
  rule.species = table.text("species");
  rule.count = static_cast<int>(table.integer("count", {1, 1e7}));
  rule.pattern = pattern_of(table);
  rule.spacing_m = table.number_or("spacing_m", rule.spacing_m, {0.01, 1e5});
  rule.dbh_mean_cm = table.number_or("dbh_mean_cm", rule.dbh_mean_cm, {1, 1000});
  rule.dbh_sd_cm = table.number_or("dbh_sd_cm", rule.dbh_sd_cm, {0, 1000});
  rule.form = form_or(table, usual_form);
  return rule;
}

Terrain terrain_of(const ConfigTable& table) {
  Terrain terrain;
  terrain.elevation_m = table.number_or("elevation_m", 0.0, {-1e4, 1e4});
  terrain.slope_rad = radians_from_degrees(table.number_or("slope_deg", 0.0, {0, 80}));
  terrain.aspect_rad = radians_from_degrees(table.number_or("aspect_deg", 0.0, {0, 360}));
  return terrain;
}

Period period_of(const ConfigTable& table) {
  Period period;
  period.origin_m = {table.number_or("origin_x_m", 0.0, {-kFarM, kFarM}),
                     table.number_or("origin_y_m", 0.0, {-kFarM, kFarM})};
  period.size_m = {table.number("size_x_m", {0.01, kFarM}), table.number("size_y_m", {0.01, kFarM})};
  return period;
}

void read_trees(const ConfigTable& table, ForestSpec& spec) {
  const bool has_inventory = table.has("inventory"), has_planting = table.has("planting");
  if (has_inventory == has_planting) {
    throw_invalid(table.where(has_inventory ? "inventory" : "planting"),
                  has_inventory ? "there are an inventory and planting rules" : "there are no trees",
                  "give either inventory = \"file.csv\" or [[forest.planting]] tables");
  }
  const TreeForm form = form_or(table, TreeForm::kStandGrown);
  if (has_inventory) {
    spec.inventory = read_inventory(table.directory() / table.text("inventory"), form);
    return;
  }
  for (const ConfigTable& rule : table.tables("planting")) spec.planting.push_back(planting_rule(rule, form));
  spec.plot_width_m = table.number("plot_width_m", {0.1, 1e5});
  spec.plot_depth_m = table.number("plot_depth_m", {0.1, 1e5});
}

Surroundings surroundings_of(const ConfigTable& table) {
  const std::string kind = table.choice_or("kind", "similar", {"none", "periodic", "mirrored", "similar"});
  for (const Surroundings s : {Surroundings::kNone, Surroundings::kPeriodic, Surroundings::kMirrored})
    if (kind == to_string(s)) return s;
  return Surroundings::kSimilar;
}

void read_plot(const ConfigTable& table, ForestSpec& spec) {
  if (table.has("plot_polygon"))
    spec.plot = read_plot_polygon(table.directory() / table.text("plot_polygon"));
  if (const auto around = table.table_if("surroundings")) {
    spec.surroundings = surroundings_of(*around);
    spec.surroundings_width_m = around->number_or("width_m", 0, {0, 1e4});
  }
}

void read_understorey(const ConfigTable& table, Understorey& under) {
  under.add = table.boolean_or("add", true);
  under.smallest_dbh_cm = table.number_or("smallest_dbh_cm", under.smallest_dbh_cm, {0.1, 100});
  under.inventoried_from_dbh_cm =
      table.number_or("inventoried_from_dbh_cm", under.inventoried_from_dbh_cm, {0, 100});
  under.stems_ratio_per_5_cm = table.number_or("stems_ratio_per_5_cm", under.stems_ratio_per_5_cm, {1.01, 5});
  under.stems_factor = table.number_or("stems_factor", under.stems_factor, {0, 1000});
  under.light_power = table.number_or("light_power", under.light_power, {0, 10});
}

// What `realism` sets, key by key.
void read_crown_fill(const ConfigTable& table, ForestSpec& spec) {
  const bool natural = table.choice_or("realism", "plain", {"plain", "natural"}) == "natural";
  apply(natural ? Realism::kNatural : Realism::kPlain, spec);
  const char* source = spec.leaf_area == LeafAreaSource::kAllometry ? "allometry" : "density";
  spec.leaf_area = table.choice_or("leaf_area", source, {"density", "allometry"}) == "allometry"
                       ? LeafAreaSource::kAllometry
                       : LeafAreaSource::kDensity;
  spec.element_area_m2 = table.number_or("element_area_m2", spec.element_area_m2, {0, 100});
  spec.rim_power = table.number_or("rim_power", spec.rim_power, {0, 20});
  spec.height_power = table.number_or("height_power", spec.height_power, {0, 20});
  spec.branch_share = table.number_or("branch_share", spec.branch_share, {0, 10});
  if (const auto under = table.table_if("understorey")) read_understorey(*under, spec.understorey);
}

void read_geometry(const ConfigTable& table, ForestSpec& spec) {
  read_crown_fill(table, spec);
  const char* usual = spec.trees == TreeSource::kCrown ? "crown" : "lsystem";
  const std::string trees = table.choice_or("trees", usual, {"lsystem", "crown"});
  spec.trees = trees == "crown" ? TreeSource::kCrown : TreeSource::kLsystem;
  spec.elements_per_tree =
      static_cast<int>(table.integer_or("elements_per_tree", spec.elements_per_tree, {1, 1e7}));
  const bool grown = table.choice_or("crown_filling", "leaves", {"leaves", "grown"}) == "grown";
  spec.filling = grown ? CrownFilling::kGrown : CrownFilling::kLeaves;
  if (const auto clumps = table.table_if("clumps")) {
    spec.clumps.radius_m = clumps->number("radius_m", {0, 100});
    spec.clumps.elements = static_cast<int>(clumps->integer_or("elements", spec.clumps.elements, {1, 1e6}));
    if (clumps->has("elements")) spec.clumps.leaf_area_m2 = 0;
    spec.clumps.leaf_area_m2 = clumps->number_or("leaf_area_m2", spec.clumps.leaf_area_m2, {0, 1e4});
  }
  spec.leaf_area_factor = table.number_or("leaf_area_factor", 1, {1e-3, 1e3});
  spec.detail = table.number_or("detail", spec.detail, {1e-4, 1});
  spec.size_classes = static_cast<int>(table.integer_or("size_classes", spec.size_classes, {1, 1000}));
  spec.variants = static_cast<int>(table.integer_or("variants", spec.variants, {1, 1000}));
  if (const auto growth = table.table_if("grow_in_light")) spec.grow_in_light = grow_in_light_of(*growth);
}

}  // namespace

std::string to_string(GrowthLight light) { return light == GrowthLight::kGrid ? "grid" : "openness"; }

ForestSpec read_forest_spec(const ConfigTable& table) {
  ForestSpec spec;
  spec.name = table.text_or("name", spec.name);
  spec.seed = static_cast<std::uint64_t>(table.integer_or("seed", 1, {0, 9.0e15}));
  read_geometry(table, spec);
  if (const auto terrain = table.table_if("terrain")) spec.terrain = terrain_of(*terrain);
  if (const auto period = table.table_if("period")) spec.period = period_of(*period);
  read_plot(table, spec);
  read_trees(table, spec);
  return spec;
}

}  // namespace sunfleck
