// Head comment in forest_spec_message.h: to the wire.
#include "server/convert/crowns_message.h"
#include "server/convert/forest_spec_message.h"
#include "server/convert/surroundings_message.h"
#include "sunfleck/v1/scene.pb.h"

namespace sunfleck {
namespace {

v1::TreeForm form_message(TreeForm form) {
  return form == TreeForm::kOpenGrown ? v1::TREE_FORM_OPEN : v1::TREE_FORM_STAND;
}

void fill_growth(const GrowInLight& growth, v1::GrowInLight& message) {
  message.set_years(growth.years);
  message.set_stop_height_m(growth.stop_height_m);
  message.set_light(growth.light == GrowthLight::kGrid ? v1::GROWTH_LIGHT_GRID : v1::GROWTH_LIGHT_OPENNESS);
  message.set_cell_m(growth.cell_m);
}

void fill_tree(const InventoryTree& tree, v1::InventoryTree& message) {
  message.set_id_tree(tree.id.value);
  message.set_species(tree.species);
  message.set_x_m(tree.x_m);
  message.set_y_m(tree.y_m);
  message.set_dbh_cm(tree.dbh_cm);
  message.set_form(form_message(tree.form));
  if (tree.height_m) message.set_height_m(*tree.height_m);
  if (tree.crown_base_m) message.set_crown_base_m(*tree.crown_base_m);
  if (tree.widest_m) message.set_widest_m(*tree.widest_m);
  if (tree.radius_n_m) message.set_radius_n_m(*tree.radius_n_m);
  if (tree.radius_s_m) message.set_radius_s_m(*tree.radius_s_m);
  if (tree.radius_e_m) message.set_radius_e_m(*tree.radius_e_m);
  if (tree.radius_w_m) message.set_radius_w_m(*tree.radius_w_m);
  if (tree.leaf_area_density_per_m) message.set_leaf_area_density_per_m(*tree.leaf_area_density_per_m);
}

void fill_rule(const PlantingRule& rule, v1::PlantingRule& message) {
  message.set_species(rule.species);
  message.set_count(rule.count);
  message.set_spacing_m(rule.spacing_m);
  message.set_dbh_mean_cm(rule.dbh_mean_cm);
  message.set_dbh_sd_cm(rule.dbh_sd_cm);
  message.set_form(form_message(rule.form));
  switch (rule.pattern) {
    case PlantingPattern::kPoissonDisc:
      return message.set_pattern(v1::PLANTING_PATTERN_POISSON_DISC);
    case PlantingPattern::kRows:
      return message.set_pattern(v1::PLANTING_PATTERN_ROWS);
    case PlantingPattern::kRandom:
      return message.set_pattern(v1::PLANTING_PATTERN_RANDOM);
  }
}

}  // namespace

void fill_message(const ForestSpec& spec, v1::ForestSpec& message) {
  message.set_name(spec.name);
  message.set_seed(spec.seed);
  message.set_trees(spec.trees == TreeSource::kCrown ? v1::TREE_SOURCE_CROWN : v1::TREE_SOURCE_LSYSTEM);
  for (const InventoryTree& tree : spec.inventory) fill_tree(tree, *message.add_inventory());
  for (const PlantingRule& rule : spec.planting) fill_rule(rule, *message.add_planting());
  message.set_plot_width_m(spec.plot_width_m);
  message.set_plot_depth_m(spec.plot_depth_m);
  message.set_elements_per_tree(spec.elements_per_tree);
  message.set_detail(spec.detail);
  message.set_size_classes(spec.size_classes);
  message.set_variants(spec.variants);
  if (spec.grow_in_light) fill_growth(*spec.grow_in_light, *message.mutable_grow_in_light());
  fill_crowns(spec, message);
  fill_surroundings(spec, message);
  message.mutable_terrain()->set_elevation_m(spec.terrain.elevation_m);
  message.mutable_terrain()->set_slope_rad(spec.terrain.slope_rad);
  message.mutable_terrain()->set_aspect_rad(spec.terrain.aspect_rad);
  if (!spec.period) return;
  message.mutable_period()->set_origin_x_m(spec.period->origin_m.x);
  message.mutable_period()->set_origin_y_m(spec.period->origin_m.y);
  message.mutable_period()->set_size_x_m(spec.period->size_m.x);
  message.mutable_period()->set_size_y_m(spec.period->size_m.y);
}

}  // namespace sunfleck
