#include "server/convert/crowns_message.h"

#include <cmath>

#include "sunfleck/v1/scene.pb.h"

namespace sunfleck {
namespace {

LeafAreaSource leaf_area_from_message(v1::LeafAreaSource source, const std::string& field,
                                      Violations& violations) {
  switch (source) {
    case v1::LEAF_AREA_SOURCE_UNSPECIFIED:
    case v1::LEAF_AREA_SOURCE_DENSITY:
      return LeafAreaSource::kDensity;
    case v1::LEAF_AREA_SOURCE_ALLOMETRY:
      return LeafAreaSource::kAllometry;
    default:
      break;
  }
  violations.add(field, "unknown source " + std::to_string(source));
  return LeafAreaSource::kDensity;
}

CrownFilling filling_from_message(v1::CrownFilling filling, const std::string& field,
                                  Violations& violations) {
  switch (filling) {
    case v1::CROWN_FILLING_UNSPECIFIED:
    case v1::CROWN_FILLING_LEAVES:
      return CrownFilling::kLeaves;
    case v1::CROWN_FILLING_GROWN:
      return CrownFilling::kGrown;
    default:
      break;
  }
  violations.add(field, "unknown filling " + std::to_string(filling));
  return CrownFilling::kLeaves;
}

void read_understorey(const v1::Understorey& message, const std::string& field, Violations& violations,
                      Understorey& under) {
  under.add = message.add();
  if (message.has_smallest_dbh_cm()) under.smallest_dbh_cm = message.smallest_dbh_cm();
  under.inventoried_from_dbh_cm = message.inventoried_from_dbh_cm();
  if (message.has_stems_ratio_per_5_cm()) under.stems_ratio_per_5_cm = message.stems_ratio_per_5_cm();
  if (message.has_stems_factor()) under.stems_factor = message.stems_factor();
  if (message.has_light_power()) under.light_power = message.light_power();
  violations.number(field + ".smallest_dbh_cm", under.smallest_dbh_cm, 0.1, 100);
  violations.number(field + ".inventoried_from_dbh_cm", under.inventoried_from_dbh_cm, 0, 100);
  violations.number(field + ".stems_ratio_per_5_cm", under.stems_ratio_per_5_cm, 1.01, 5);
  violations.number(field + ".stems_factor", under.stems_factor, 0, 1000);
  violations.number(field + ".light_power", under.light_power, 0, 10);
}

}  // namespace

void read_crowns(const v1::ForestSpec& message, const std::string& field, Violations& violations,
                 ForestSpec& spec) {
  if (message.has_leaf_area_factor()) spec.leaf_area_factor = message.leaf_area_factor();
  spec.leaf_area = leaf_area_from_message(message.leaf_area(), field + ".leaf_area", violations);
  spec.filling = filling_from_message(message.filling(), field + ".filling", violations);
  spec.height_power = message.height_power();
  spec.element_area_m2 = message.element_area_m2();
  spec.rim_power = message.rim_power();
  spec.branch_share = message.branch_share();
  spec.clumps.radius_m = message.clumps().radius_m();
  if (message.clumps().has_elements()) spec.clumps.elements = message.clumps().elements();
  spec.clumps.leaf_area_m2 = message.clumps().leaf_area_m2();
  violations.number(field + ".leaf_area_factor", spec.leaf_area_factor, 1e-3, 1e3);
  violations.number(field + ".element_area_m2", spec.element_area_m2, 0, 100);
  violations.number(field + ".height_power", spec.height_power, 0, 20);
  violations.number(field + ".rim_power", spec.rim_power, 0, 20);
  violations.number(field + ".branch_share", spec.branch_share, 0, 10);
  violations.number(field + ".clumps.radius_m", spec.clumps.radius_m, 0, 100);
  violations.integer(field + ".clumps.elements", spec.clumps.elements, 1, 1'000'000);
  violations.number(field + ".clumps.leaf_area_m2", spec.clumps.leaf_area_m2, 0, 1e4);
  read_understorey(message.understorey(), field + ".understorey", violations, spec.understorey);
}

void fill_crowns(const ForestSpec& spec, v1::ForestSpec& message) {
  message.set_leaf_area_factor(spec.leaf_area_factor);
  message.set_leaf_area(spec.leaf_area == LeafAreaSource::kAllometry ? v1::LEAF_AREA_SOURCE_ALLOMETRY
                                                                     : v1::LEAF_AREA_SOURCE_DENSITY);
  message.set_filling(spec.filling == CrownFilling::kGrown ? v1::CROWN_FILLING_GROWN
                                                           : v1::CROWN_FILLING_LEAVES);
  message.set_height_power(spec.height_power);
  message.set_element_area_m2(spec.element_area_m2);
  message.set_rim_power(spec.rim_power);
  message.set_branch_share(spec.branch_share);
  message.mutable_clumps()->set_radius_m(spec.clumps.radius_m);
  message.mutable_clumps()->set_elements(spec.clumps.elements);
  message.mutable_clumps()->set_leaf_area_m2(spec.clumps.leaf_area_m2);
  v1::Understorey& under = *message.mutable_understorey();
  under.set_add(spec.understorey.add);
  under.set_smallest_dbh_cm(spec.understorey.smallest_dbh_cm);
  under.set_inventoried_from_dbh_cm(spec.understorey.inventoried_from_dbh_cm);
  under.set_stems_ratio_per_5_cm(spec.understorey.stems_ratio_per_5_cm);
  under.set_stems_factor(spec.understorey.stems_factor);
  under.set_light_power(spec.understorey.light_power);
}

double predicted_crown_elements(const ForestSpec& spec, std::uint64_t trees) {
  const double even = static_cast<double>(trees) * spec.elements_per_tree;
  if (!(spec.element_area_m2 > 0)) return even;
  constexpr double kLeafPerDbh2 = 0.2;
  double leaf_m2 = 0;
  for (const InventoryTree& tree : spec.inventory) leaf_m2 += kLeafPerDbh2 * tree.dbh_cm * tree.dbh_cm;
  for (const PlantingRule& rule : spec.planting)
    leaf_m2 += kLeafPerDbh2 * rule.count * (std::pow(rule.dbh_mean_cm, 2) + std::pow(rule.dbh_sd_cm, 2));
  return spec.leaf_area_factor * leaf_m2 / spec.element_area_m2;
}

}  // namespace sunfleck
