// Poisson disc: darts are thrown evenly at the plot and kept if no tree stands nearer than the spacing; this
// gives an even density also when few trees are asked for. Saturation (0.547 of the plot covered by discs of
// half the spacing) is approached, not reached: a rule gives up after kTriesPerTree darts in a row for one
// tree. Rows: a square lattice of step `spacing`, filled row by row, places nearer than half a step to an
// earlier tree left out. Random: anywhere. Diameters are normal, those under 1 cm are drawn again.

#include "sim/forest/planting.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {

namespace {

constexpr int kTriesPerTree = 4000;
constexpr double kLeastDbhCm = 1.0, kMostDbhCm = 1000.0;

// Looks at the stop token in one of 1024 rounds of a loop (each round costs a microsecond or so).
void check_now_and_then(std::size_t round, const RunControl& control) {
  if (round % 1024 == 0) control.check();
}

// Trees by square cells of the spacing, for "is anyone nearer than the spacing?".
class Neighbourhood {
 public:
  Neighbourhood(double reach_m, const std::vector<InventoryTree>& trees, const RunControl& control)
      : reach_m_(reach_m) {
    for (std::size_t i = 0; i < trees.size(); ++i) {
      check_now_and_then(i, control);
      add({trees[i].x_m, trees[i].y_m});
    }
  }
  void add(const Vec2& place) { cells_[key(cell(place.x), cell(place.y))].push_back(place); }
  bool is_free(const Vec2& place) const {
    for (std::int64_t i = cell(place.x) - 1; i <= cell(place.x) + 1; ++i) {
      for (std::int64_t j = cell(place.y) - 1; j <= cell(place.y) + 1; ++j) {
        const auto found = cells_.find(key(i, j));
        if (found == cells_.end()) continue;
        for (const Vec2& other : found->second) {
          if (glm::distance(other, place) < reach_m_) return false;
        }
      }
    }
    return true;
  }

 private:
  std::int64_t cell(double coordinate_m) const {
    return static_cast<std::int64_t>(std::floor(coordinate_m / reach_m_));
  }
  static std::uint64_t key(std::int64_t i, std::int64_t j) {
    return (static_cast<std::uint64_t>(i) << 32) ^ (static_cast<std::uint64_t>(j) & 0xFFFFFFFFU);
  }
  double reach_m_;
  std::unordered_map<std::uint64_t, std::vector<Vec2>> cells_;
};

double draw_dbh_cm(const PlantingRule& rule, const std::string& where, RandomStream& random) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const double dbh_cm = rule.dbh_mean_cm + rule.dbh_sd_cm * random.normal();
    if (dbh_cm > kMostDbhCm)
      throw_invalid(where + ".dbh_sd_cm",
                    std::to_string(rule.dbh_sd_cm) + " round a mean of " + std::to_string(rule.dbh_mean_cm) +
                        " gives a tree of " + std::to_string(dbh_cm) + " cm",
                    "a spread that keeps diameters under 1000 cm, such as a fifth of the mean");
    if (dbh_cm >= kLeastDbhCm) return dbh_cm;
  }
  return kLeastDbhCm;
}

std::string rule_label(std::size_t index) { return "forest.planting[" + std::to_string(index) + "]"; }

struct Plot {
  double width_m, depth_m;
};

std::vector<Vec2> poisson_disc_places(const PlantingRule& rule, const Plot& plot, Neighbourhood neighbours,
                                      RandomStream& random, const RunControl& control) {
  std::vector<Vec2> places;
  int tries = 0;
  std::size_t darts = 0;
  while (places.size() < static_cast<std::size_t>(rule.count) && tries++ < kTriesPerTree) {
    check_now_and_then(++darts, control);
    const Vec2 place{random.uniform(0.0, plot.width_m), random.uniform(0.0, plot.depth_m)};
    if (!neighbours.is_free(place)) continue;
    neighbours.add(place);
    places.push_back(place);
    tries = 0;
  }
  return places;
}

std::vector<Vec2> row_places(const PlantingRule& rule, const Plot& plot, const Neighbourhood& neighbours,
                             const RunControl& control) {
  std::vector<Vec2> places;
  const double step_m = rule.spacing_m;
  std::size_t round = 0;
  for (double y_m = 0.5 * step_m; y_m < plot.depth_m; y_m += step_m) {
    for (double x_m = 0.5 * step_m; x_m < plot.width_m; x_m += step_m) {
      check_now_and_then(round++, control);
      if (places.size() == static_cast<std::size_t>(rule.count)) return places;
      if (neighbours.is_free({x_m, y_m})) places.push_back({x_m, y_m});
    }
  }
  return places;
}

std::vector<Vec2> random_places(const PlantingRule& rule, const Plot& plot, RandomStream& random,
                                const RunControl& control) {
  std::vector<Vec2> places;
  while (places.size() < static_cast<std::size_t>(rule.count)) {
    check_now_and_then(places.size(), control);
    const double x_m = random.uniform(0.0, plot.width_m);
    places.push_back({x_m, random.uniform(0.0, plot.depth_m)});
  }
  return places;
}

std::vector<Vec2> places_of(const PlantingRule& rule, const Plot& plot,
                            const std::vector<InventoryTree>& trees, RandomStream& random,
                            const RunControl& control) {
  switch (rule.pattern) {
    case PlantingPattern::kPoissonDisc:
      return poisson_disc_places(rule, plot, {rule.spacing_m, trees, control}, random, control);
    case PlantingPattern::kRows:
      return row_places(rule, plot, {0.5 * rule.spacing_m, trees, control}, control);
    case PlantingPattern::kRandom:
      return random_places(rule, plot, random, control);
  }
  return {};
}

void require(bool right, const std::string& where, const std::string& problem, const std::string& remedy) {
  if (!right) throw_invalid(where, problem, remedy);
}

void check_rule(const PlantingRule& rule, const Plot& plot, const std::string& where) {
  const auto within = [](double value, double lo, double hi) { return value >= lo && value <= hi; };
  require(!rule.species.empty(), where + ".species", "is empty", "name a species");
  require(rule.count > 0, where + ".count", "is " + std::to_string(rule.count), "1 or more trees");
  require(within(rule.dbh_mean_cm, kLeastDbhCm, kMostDbhCm), where + ".dbh_mean_cm",
          "is " + std::to_string(rule.dbh_mean_cm), "1 to 1000 cm");
  require(within(rule.dbh_sd_cm, 0, kMostDbhCm), where + ".dbh_sd_cm", "is " + std::to_string(rule.dbh_sd_cm),
          "0 to 1000 cm");
  if (rule.pattern == PlantingPattern::kRandom) return;
  const double least_m = std::max(plot.width_m, plot.depth_m) * 1e-6;
  require(within(rule.spacing_m, std::max(0.01, least_m), 1e6), where + ".spacing_m",
          "is " + std::to_string(rule.spacing_m), "0.01 m or more, and a millionth of the plot");
}

void check_plot(const Plot& plot) {
  const auto sane = [](double side_m) { return side_m > 0 && side_m <= 1e6; };
  require(sane(plot.width_m), "forest.plot_width_m", "is " + std::to_string(plot.width_m), "over 0 to 1e6 m");
  require(sane(plot.depth_m), "forest.plot_depth_m", "is " + std::to_string(plot.depth_m), "over 0 to 1e6 m");
}

void check_planting(const ForestSpec& spec, const Plot& plot) {
  check_plot(plot);
  std::size_t total = 0;
  for (std::size_t i = 0; i < spec.planting.size(); ++i) {
    check_rule(spec.planting[i], plot, rule_label(i));
    total += static_cast<std::size_t>(spec.planting[i].count);
  }
  if (total <= kMostPlantedTrees) return;
  throw Error(ErrorKind::kLimitExceeded, "forest.planting", std::to_string(total) + " trees are too many",
              "at most " + std::to_string(kMostPlantedTrees));
}

void plant_rule(const ForestSpec& spec, std::size_t index, const RunControl& control, PlantedTrees& planted) {
  const PlantingRule& rule = spec.planting[index];
  RandomStream where(mix_seed(spec.seed, 1), index, RandomPurpose::kPlanting);
  RandomStream size(mix_seed(spec.seed, 2), index, RandomPurpose::kPlanting);
  const std::vector<Vec2> places =
      places_of(rule, {spec.plot_width_m, spec.plot_depth_m}, planted.trees, where, control);
  for (const Vec2& place : places) {
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(planted.trees.size() + 1)};
    tree.species = rule.species;
    tree.x_m = place.x;
    tree.y_m = place.y;
    tree.dbh_cm = draw_dbh_cm(rule, rule_label(index), size);
    tree.form = rule.form;
    tree.where = rule_label(index);
    planted.trees.push_back(tree);
  }
  if (places.size() == static_cast<std::size_t>(rule.count)) return;
  planted.shortfalls.push_back(rule_label(index) + ": " + std::to_string(places.size()) + " of " +
                               std::to_string(rule.count) + " " + rule.species +
                               " fit; a smaller spacing_m or a larger plot holds more");
}

}  // namespace

PlantedTrees plant_trees(const ForestSpec& spec, const RunControl& control) {
  check_planting(spec, {spec.plot_width_m, spec.plot_depth_m});
  PlantedTrees planted;
  for (std::size_t i = 0; i < spec.planting.size(); ++i) plant_rule(spec, i, control, planted);
  return planted;
}

}  // namespace sunfleck
