// Where a crown is widest, as a share of its length above its base: the 313 measured trees of the stands
// Cloture20 and Bechefa (SamsaRaLight data, G. Ligot) average 0.33 (spruce .34, beech .31, oak .42, fir .51,
// Douglas-fir .17; standard deviation within a species about .15), so a third serves all species.

#include "sim/forest/tree_size.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {

namespace {

constexpr double kLeastRadiusM = 0.01;
constexpr double kWidestFraction = 1.0 / 3.0;
constexpr double kLeastBaseShare = 0.01;  // grammars need a stem below the crown

void require(bool right, const InventoryTree& tree, const std::string& what, const std::string& remedy) {
  if (!right) throw_invalid(tree_label(tree), what, remedy);
}

// Of a species with such numbers: validate() has looked.
bool is_open(const InventoryTree& tree) { return tree.form == TreeForm::kOpenGrown; }

double crown_base_m(const InventoryTree& tree, const Species& species, double height_m) {
  if (tree.crown_base_m) return *tree.crown_base_m;
  const double ratio = is_open(tree) ? species.open_grown->crown_length_ratio : species.crown_length_ratio;
  const double usual_m = (1.0 - ratio) * height_m;
  return tree.widest_m ? std::min(usual_m, 0.8 * *tree.widest_m) : usual_m;  // stays under what was measured
}

std::array<double, 4> radii_nesw_m(const InventoryTree& tree, const Species& species) {
  const std::array<std::optional<double>, 4> measured{tree.radius_n_m, tree.radius_e_m, tree.radius_s_m,
                                                      tree.radius_w_m};
  double sum_m = 0;
  int count = 0;
  for (const auto& radius : measured) {
    sum_m += radius.value_or(0.0);
    count += radius.has_value() ? 1 : 0;
  }
  require(count == 0 || sum_m > 0, tree, "all measured crown radii are 0",
          "give a radius, or leave them out");
  const double fallback_m =
      count > 0 ? sum_m / count : expected_size(species, tree.dbh_cm, tree.form).crown_radius_m;
  std::array<double, 4> radii{};
  for (std::size_t i = 0; i < 4; ++i) radii[i] = std::max(measured[i].value_or(fallback_m), kLeastRadiusM);
  return radii;
}

}  // namespace

std::string tree_label(const InventoryTree& tree) {
  return (tree.where.empty() ? "" : tree.where + ": ") + "tree " + std::to_string(tree.id.value) + " (" +
         tree.species + ")";
}

void validate(const InventoryTree& tree) {
  const auto within = [](double value, double lo, double hi) { return value >= lo && value <= hi; };
  require(within(tree.x_m, -1e7, 1e7) && within(tree.y_m, -1e7, 1e7), tree, "its position is no place",
          "x and y in metres, within 10,000 km");
  require(within(tree.dbh_cm, 0.1, 1000), tree, "its diameter is " + std::to_string(tree.dbh_cm) + " cm",
          "a stem diameter from 0.1 to 1000 cm");
  for (const auto& height : {tree.height_m, tree.crown_base_m, tree.widest_m}) {
    require(within(height.value_or(1), 0, 150), tree, "a height is out of range", "heights from 0 to 150 m");
  }
  for (const auto& radius : {tree.radius_n_m, tree.radius_s_m, tree.radius_e_m, tree.radius_w_m}) {
    require(within(radius.value_or(1), 0, 100), tree, "a crown radius is out of range",
            "radii from 0 to 100 m");
  }
  require(within(tree.leaf_area_density_per_m.value_or(1), 0, 100), tree, "crown_lad is out of range",
          "leaf area density from 0 to 100 m2/m3");
}

double tree_height_m(const InventoryTree& tree, const Species& species) {
  if (tree.height_m) return *tree.height_m;
  const double measured_m = std::max(tree.crown_base_m.value_or(0.0), tree.widest_m.value_or(0.0));
  return std::max(expected_size(species, tree.dbh_cm, tree.form).height_m,
                  1.1 * measured_m);  // stays above what was measured
}

CrownShape tree_crown(const InventoryTree& tree, const Species& species) {
  CrownShape crown;
  crown.height_m = tree_height_m(tree, species);
  crown.base_m = crown_base_m(tree, species, crown.height_m);
  const double length_m = crown.height_m - crown.base_m;
  crown.widest_m = tree.widest_m.value_or(crown.base_m + kWidestFraction * length_m);
  require(length_m > 0 && crown.base_m <= crown.widest_m && crown.widest_m <= crown.height_m, tree,
          "its crown is upside down", "heights must be crown base <= widest <= top, base < top");
  crown.radius_nesw_m = radii_nesw_m(tree, species);
  crown.dbh_m = 0.01 * tree.dbh_cm;
  return crown;
}

double tree_leaf_area_m2(const InventoryTree& tree, const Species& species, const CrownShape& crown) {
  const double area_m2 = tree.leaf_area_density_per_m ? *tree.leaf_area_density_per_m * crown_volume_m3(crown)
                                                      : species.leaf_area_m2(tree.dbh_cm);
  require(area_m2 > 0 && std::isfinite(area_m2), tree, "it has no foliage area",
          "crown_lad above 0, or leave it out; remove trees without leaves");
  return area_m2;
}

bool is_measured(const InventoryTree& tree) {
  return tree.height_m || tree.crown_base_m || tree.widest_m || tree.radius_n_m || tree.radius_s_m ||
         tree.radius_e_m || tree.radius_w_m || tree.leaf_area_density_per_m;
}

TreeSize tree_size(const InventoryTree& tree, const Species& species) {
  const CrownShape crown = tree_crown(tree, species);
  double sum_m = 0;
  for (const double radius_m : crown.radius_nesw_m) sum_m += radius_m;
  return {crown.dbh_m, crown.height_m, std::max(crown.base_m, kLeastBaseShare * crown.height_m), 0.25 * sum_m,
          tree_leaf_area_m2(tree, species, crown)};
}

}  // namespace sunfleck
