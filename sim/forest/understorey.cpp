#include "sim/forest/understorey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/tree_size.h"

namespace sunfleck {
namespace {

constexpr double kSeriesStepCm = 5, kClassCm = 2.5, kThickestLimitCm = 30, kBreastHeightM = 1.3;
constexpr double kExtinction = 0.5;  // leaves that point everywhere alike
constexpr int kTriesPerTree = 1000;

void check(const Understorey& o) {
  const auto require = [](bool right, const char* key, const char* remedy) {
    if (!right) throw_invalid(std::string("forest.understorey.") + key, "is out of range", remedy);
  };
  require(o.smallest_dbh_cm >= 0.1 && o.smallest_dbh_cm <= 100, "smallest_dbh_cm", "0.1 to 100 cm");
  require(o.inventoried_from_dbh_cm >= 0 && o.inventoried_from_dbh_cm <= 100, "inventoried_from_dbh_cm",
          "0 (found from the diameters) to 100 cm");
  require(o.stems_ratio_per_5_cm > 1 && o.stems_ratio_per_5_cm <= 5, "stems_ratio_per_5_cm",
          "above 1, up to 5");
  require(o.stems_factor >= 0 && o.stems_factor <= 1000, "stems_factor", "0 to 1000");
  require(o.light_power >= 0 && o.light_power <= 10, "light_power", "0 to 10");
}

// A crown as a shade on the ground: leaf area per covered area, over the quarter ellipses between its radii.
struct Shade {
  Vec2 foot_m;
  std::array<double, 4> radius_nesw_m;
  double leaf_area_index;

  double at(const Vec2& place_m) const {
    const Vec2 off = place_m - foot_m;
    const double rx = off.x >= 0 ? radius_nesw_m[1] : radius_nesw_m[3];
    const double ry = off.y >= 0 ? radius_nesw_m[0] : radius_nesw_m[2];
    return off.x * off.x / (rx * rx) + off.y * off.y / (ry * ry) <= 1 ? leaf_area_index : 0;
  }
};

std::vector<Shade> shades_of(const std::vector<InventoryTree>& trees, const SpeciesLibrary& library) {
  std::vector<Shade> shades;
  for (const InventoryTree& tree : trees) {
    const Species& species = library.find(tree.species, tree_label(tree));
    const CrownShape crown = tree_crown(tree, species);
    const auto& r = crown.radius_nesw_m;
    const double covered_m2 = 0.25 * kPi * (r[0] + r[2]) * (r[1] + r[3]);
    shades.push_back(
        {{tree.x_m, tree.y_m}, r, species.leaf_area_m2(tree.dbh_cm, crown.height_m) / covered_m2});
  }
  return shades;
}

double light_at(const std::vector<Shade>& shades, const Vec2& place_m) {
  double depth = 0;
  for (const Shade& shade : shades) depth += shade.at(place_m);
  return std::exp(-kExtinction * depth);
}

// By the geometric series cut off at the limit.
double draw_dbh_cm(double from_cm, double limit_cm, double scale_cm, RandomStream& random) {
  const double cut = 1 - std::exp(-(limit_cm - from_cm) / scale_cm);
  return from_cm - scale_cm * std::log(1 - cut * random.uniform());
}

std::optional<Vec2> draw_place(const PlotPolygon& plot, const std::vector<Shade>& shades, double light_power,
                               RandomStream& random) {
  const PlotBounds box = bounds(plot);
  for (int i = 0; i < kTriesPerTree; ++i) {
    const Vec2 place(random.uniform(box.lo_m.x, box.hi_m.x), random.uniform(box.lo_m.y, box.hi_m.y));
    const double chance = random.uniform();
    if (contains(plot, place) && chance <= std::pow(light_at(shades, place), light_power)) return place;
  }
  return std::nullopt;
}

// On the chord of the species' height curve from breast height to the limit: height curves of a stand bend
// down, so the chord is no taller than the trees (the S-shaped foot of a fitted curve would lay them flat).
double height_m(const Species& species, double dbh_cm, double limit_cm) {
  return kBreastHeightM + dbh_cm / limit_cm * (species.height_m(limit_cm) - kBreastHeightM);
}

std::vector<std::string> small_species(const std::vector<InventoryTree>& trees, double limit_cm) {
  std::vector<std::string> names;
  for (const InventoryTree& tree : trees)
    if (tree.dbh_cm < limit_cm + 2 * kSeriesStepCm) names.push_back(tree.species);
  return names;
}

std::string said(std::size_t stems, double from_cm, double limit_cm) {
  char text[160];
  std::snprintf(text, sizeof text, "%zu trees of %.3g to %.3g cm, too small for the inventory, were added",
                stems, from_cm, limit_cm);
  return text;
}

}  // namespace

std::optional<double> calliper_limit_cm(const std::vector<InventoryTree>& trees) {
  std::array<int, static_cast<std::size_t>(kThickestLimitCm / kClassCm)> stems{};
  for (const InventoryTree& tree : trees)
    if (const auto c = static_cast<std::size_t>(tree.dbh_cm / kClassCm); c < stems.size()) ++stems[c];
  const auto most = std::max_element(stems.begin(), stems.end());
  const int below = std::accumulate(stems.begin(), most, 0);
  if (*most == 0 || 2 * below >= *most) return std::nullopt;
  return kClassCm * static_cast<double>(most - stems.begin());
}

double missing_stems(const std::vector<InventoryTree>& trees, double limit_cm, const Understorey& options) {
  const double scale_cm = kSeriesStepCm / std::log(options.stems_ratio_per_5_cm),
               width_cm = 2 * kSeriesStepCm;
  double above = 0, below = 0;
  for (const InventoryTree& tree : trees) {
    above += tree.dbh_cm >= limit_cm && tree.dbh_cm < limit_cm + width_cm ? 1 : 0;
    below += tree.dbh_cm >= options.smallest_dbh_cm && tree.dbh_cm < limit_cm ? 1 : 0;
  }
  const double series =
      (std::exp((limit_cm - options.smallest_dbh_cm) / scale_cm) - 1) / (1 - std::exp(-width_cm / scale_cm));
  return std::max(0.0, above * series - below);
}

std::vector<InventoryTree> understorey_trees(const std::vector<InventoryTree>& trees, const PlotPolygon& plot,
                                             const Understorey& options, const SpeciesLibrary& species,
                                             std::uint64_t seed, std::vector<std::string>& notes) {
  check(options);
  const std::optional<double> limit = options.inventoried_from_dbh_cm > 0
                                          ? std::optional(options.inventoried_from_dbh_cm)
                                          : calliper_limit_cm(trees);
  if (!limit || *limit <= options.smallest_dbh_cm) {
    notes.push_back("no understorey was added: the diameters do not look cut off at a callipering limit");
    return {};
  }
  const auto count =
      static_cast<std::size_t>(std::lround(options.stems_factor * missing_stems(trees, *limit, options)));
  const std::vector<std::string> names = small_species(trees, *limit);
  const std::vector<Shade> shades = shades_of(trees, species);
  const double scale_cm = kSeriesStepCm / std::log(options.stems_ratio_per_5_cm);
  std::vector<InventoryTree> added;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(seed, i, RandomPurpose::kUnderstorey);
    const auto place = draw_place(plot, shades, options.light_power, random);
    if (!place) continue;
    InventoryTree tree;
    tree.id = virtual_tree(kFirstUnderstorey + i);
    tree.species = names[random.below(static_cast<std::uint32_t>(names.size()))];
    tree.x_m = place->x;
    tree.y_m = place->y;
    tree.dbh_cm = draw_dbh_cm(options.smallest_dbh_cm, *limit, scale_cm, random);
    tree.height_m = height_m(species.find(tree.species, "understorey"), tree.dbh_cm, *limit);
    tree.where = "understorey";
    added.push_back(std::move(tree));
  }
  if (!added.empty()) notes.push_back(said(added.size(), options.smallest_dbh_cm, *limit));
  return added;
}

}  // namespace sunfleck
