#include "sim/forest/surroundings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/plot_polygon.h"

namespace sunfleck {
namespace {

constexpr double kHeightsAround = 2;  // default width in heights of the 90th-percentile tree
constexpr double kLeastFill = 0.9;    // of its rectangle, for a plot to be mirrored
constexpr double kNeighbourQuantile = 0.1;
constexpr int kTriesPerTree = 60;

double quantile(std::vector<double> values, double share) {
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
  return values[place];
}

// Where trees stand, in squares of the distance asked for: only nine of them need a look.
class Neighbours {
 public:
  explicit Neighbours(double distance_m) : distance_m_(std::max(distance_m, 1e-3)) {}
  void add(const Vec2& point_m) { squares_[square(point_m)].push_back(point_m); }
  double nearest_m(const Vec2& point_m) const {  // beyond the distance: infinity
    double nearest = INFINITY;
    const auto [column, row] = square(point_m);
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        if (const auto found = squares_.find({column + dx, row + dy}); found != squares_.end())
          for (const Vec2& other : found->second) nearest = std::min(nearest, glm::distance(point_m, other));
    return nearest;
  }

 private:
  using Square = std::pair<long, long>;
  Square square(const Vec2& p) const {
    return {std::lround(std::floor(p.x / distance_m_)), std::lround(std::floor(p.y / distance_m_))};
  }
  double distance_m_;
  std::map<Square, std::vector<Vec2>> squares_;
};

// Tenth percentile of the distances between neighbours.
double least_distance_m(const std::vector<InventoryTree>& trees, double area_m2) {
  const double mean_m = std::sqrt(area_m2 / static_cast<double>(trees.size()));
  Neighbours all(2 * mean_m);
  std::vector<double> distances;
  for (const InventoryTree& tree : trees) {  // each with those before it and, by turns, those after it
    const double d = all.nearest_m({tree.x_m, tree.y_m});
    if (std::isfinite(d)) distances.push_back(d);
    all.add({tree.x_m, tree.y_m});
  }
  return distances.empty() ? 0.0 : std::min(quantile(distances, kNeighbourQuantile), 0.7 * mean_m);
}

// The plot's own trees in a random order, again and again: densities and basal area come out right.
class Donors {
 public:
  Donors(const std::vector<InventoryTree>& trees, std::uint64_t seed) : trees_(trees), seed_(seed) {}
  InventoryTree next(std::size_t number, const Vec2& place_m) {
    if (number % trees_.size() == 0) shuffle(number / trees_.size());
    InventoryTree tree = trees_[order_[number % trees_.size()]];
    RandomStream random(seed_, number, RandomPurpose::kSurroundings);
    tree.copy_of = tree.id;
    tree.copy_yaw_rad = random.uniform(0, 2 * kPi);
    tree.id = virtual_tree(number);
    tree.x_m = place_m.x;
    tree.y_m = place_m.y;
    tree.where = "surroundings";
    return tree;
  }

 private:
  void shuffle(std::uint64_t round) {
    order_.resize(trees_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    RandomStream random(mix_seed(seed_, round), 0, RandomPurpose::kSurroundings);
    for (std::size_t i = order_.size(); i > 1; --i)
      std::swap(order_[i - 1], order_[random.below(static_cast<std::uint32_t>(i))]);
  }
  const std::vector<InventoryTree>& trees_;
  std::uint64_t seed_;
  std::vector<std::size_t> order_;
};

std::string count_sentence(std::size_t asked, std::size_t stood, const char* where) {
  char text[160];
  std::snprintf(text, sizeof text, "%zu trees like the plot's own stand %s%s", stood, where,
                stood < asked ? ", fewer than its density asks for: the rest found no room" : "");
  return text;
}

// Trees at the plot's density in [lo, hi] without the plot.
void add_similar(const std::vector<InventoryTree>& trees, const PlotPolygon& plot, const Vec2& lo_m,
                 const Vec2& hi_m, std::uint64_t seed, const char* where, SurroundedStand& stand) {
  const double plot_m2 = area_m2(plot), around_m2 = (hi_m.x - lo_m.x) * (hi_m.y - lo_m.y) - plot_m2;
  const auto asked = static_cast<std::size_t>(
      std::lround(std::max(0.0, around_m2) / plot_m2 * static_cast<double>(trees.size())));
  const double apart_m = least_distance_m(trees, plot_m2);
  Neighbours taken(apart_m);
  for (const InventoryTree& tree : trees) taken.add({tree.x_m, tree.y_m});
  Donors donors(trees, seed);
  std::size_t stood = 0;
  for (std::size_t i = 0; i < asked; ++i) {
    RandomStream random(mix_seed(seed, 1), i, RandomPurpose::kSurroundings);
    for (int attempt = 0; attempt < kTriesPerTree; ++attempt) {
      const Vec2 place(random.uniform(lo_m.x, hi_m.x), random.uniform(lo_m.y, hi_m.y));
      if (contains(plot, place) || taken.nearest_m(place) < apart_m) continue;
      taken.add(place);
      stand.trees.push_back(donors.next(stood++, place));
      break;
    }
  }
  if (asked > 0) stand.notes.push_back(count_sentence(asked, stood, where));
}

double default_width_m(const std::vector<InventoryTree>& trees) {
  std::vector<double> heights;
  for (const InventoryTree& tree : trees) heights.push_back(tree.height_m.value_or(25.0));
  return kHeightsAround * quantile(heights, 0.9);
}

// The tree's image beyond a side: position and crown mirrored along x, y or both.
InventoryTree mirrored(const InventoryTree& tree, const Vec2& place_m, bool along_x, bool along_y,
                       std::size_t number) {
  InventoryTree image = tree;
  image.id = virtual_tree(number);
  image.x_m = place_m.x;
  image.y_m = place_m.y;
  image.where = "surroundings";
  if (along_x) std::swap(image.radius_e_m, image.radius_w_m);
  if (along_y) std::swap(image.radius_n_m, image.radius_s_m);
  return image;
}

void add_mirrored(const std::vector<InventoryTree>& trees, const PlotBounds& box, double width_m,
                  SurroundedStand& stand) {
  std::size_t number = 0;
  for (int side_x = -1; side_x <= 1; ++side_x)
    for (int side_y = -1; side_y <= 1; ++side_y) {
      if (side_x == 0 && side_y == 0) continue;
      for (const InventoryTree& tree : trees) {
        const Vec2 edge(side_x < 0 ? box.lo_m.x : box.hi_m.x, side_y < 0 ? box.lo_m.y : box.hi_m.y);
        const Vec2 place(side_x == 0 ? tree.x_m : 2 * edge.x - tree.x_m,
                         side_y == 0 ? tree.y_m : 2 * edge.y - tree.y_m);
        if ((side_x != 0 && std::fabs(place.x - edge.x) > width_m) ||
            (side_y != 0 && std::fabs(place.y - edge.y) > width_m))
          continue;
        stand.trees.push_back(mirrored(tree, place, side_x != 0, side_y != 0, number++));
      }
    }
  if (number > 0) stand.notes.push_back(std::to_string(number) + " mirror images stand around the plot");
}

}  // namespace

std::string to_string(Surroundings kind) {
  constexpr const char* kNames[] = {"none", "periodic", "mirrored", "similar"};
  return kNames[static_cast<int>(kind)];
}

SurroundedStand surround(const std::vector<InventoryTree>& trees, const PlotPolygon& plot, Surroundings kind,
                         double width_m, std::uint64_t seed) {
  if (!(width_m >= 0 && width_m <= 1e4))
    throw_invalid("forest.surroundings.width_m", "is no width", "0 to 10000 m");
  SurroundedStand stand{trees, std::nullopt, {}};
  if (trees.empty()) return stand;
  const PlotBounds box = bounds(plot);
  const double width = width_m > 0 ? width_m : default_width_m(trees);
  switch (kind) {
    case Surroundings::kNone:
      break;
    case Surroundings::kPeriodic:
      stand.period = Period{box.lo_m, box.hi_m - box.lo_m};
      add_similar(trees, plot, box.lo_m, box.hi_m, seed, "between the plot and its rectangle, which repeats",
                  stand);
      break;
    case Surroundings::kMirrored:
      if (area_m2(plot) < kLeastFill * (box.hi_m.x - box.lo_m.x) * (box.hi_m.y - box.lo_m.y))
        throw_invalid("forest.surroundings", "a plot that is no rectangle cannot be mirrored",
                      "kind = \"similar\" or \"periodic\"");
      add_mirrored(trees, box, width, stand);
      break;
    case Surroundings::kSimilar:
      add_similar(trees, plot, box.lo_m - width, box.hi_m + width, seed, "around the plot", stand);
      break;
  }
  return stand;
}

}  // namespace sunfleck
