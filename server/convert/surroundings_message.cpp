// Head comment in surroundings_message.h.
#include "server/convert/surroundings_message.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "sunfleck/v1/scene.pb.h"

namespace sunfleck {
namespace {

constexpr double kFarthest_m = 1e6, kWidest_m = 1e4;
// Of the strip where none is given: 3.7 tall trees of 40 m.
constexpr double kUsualWidth_m = 150;
constexpr std::size_t kMostCorners = 1000;

Surroundings kind_from_message(v1::Surroundings kind, const std::string& field, Violations& violations) {
  switch (kind) {
    case v1::SURROUNDINGS_UNSPECIFIED:
    case v1::SURROUNDINGS_NONE:
      return Surroundings::kNone;
    case v1::SURROUNDINGS_PERIODIC:
      return Surroundings::kPeriodic;
    case v1::SURROUNDINGS_MIRRORED:
      return Surroundings::kMirrored;
    case v1::SURROUNDINGS_SIMILAR:
      return Surroundings::kSimilar;
    default:
      break;
  }
  violations.add(field, "unknown surroundings " + std::to_string(kind));
  return Surroundings::kNone;
}

v1::Surroundings message_kind(Surroundings kind) {
  switch (kind) {
    case Surroundings::kNone:
      return v1::SURROUNDINGS_NONE;
    case Surroundings::kPeriodic:
      return v1::SURROUNDINGS_PERIODIC;
    case Surroundings::kMirrored:
      return v1::SURROUNDINGS_MIRRORED;
    case Surroundings::kSimilar:
      return v1::SURROUNDINGS_SIMILAR;
  }
  return v1::SURROUNDINGS_UNSPECIFIED;
}

void read_polygon(const v1::ForestSpec& message, const std::string& field, Violations& violations,
                  ForestSpec& spec) {
  const auto count = static_cast<std::size_t>(message.plot_polygon_size());
  if (count == 0 || !violations.count(field, count, 3, kMostCorners)) return;
  std::vector<Vec2> corners;
  bool good = true;
  for (const v1::PlotCorner& corner : message.plot_polygon()) {
    const std::string place = at(field, corners.size());
    good = violations.number(place + ".x_m", corner.x_m(), -kFarthest_m, kFarthest_m) && good;
    good = violations.number(place + ".y_m", corner.y_m(), -kFarthest_m, kFarthest_m) && good;
    corners.emplace_back(corner.x_m(), corner.y_m());
  }
  if (!good) return;
  try {
    spec.plot = plot_polygon(std::move(corners), field, [&](std::size_t i) { return at(field, i); });
  } catch (const Error& error) {
    violations.add(error.where(), error.problem() + " (" + error.remedy() + ")");
  }
}

// Of the plot, or of the rectangle that counts as the plot: around the trees and half their mean distance.
PlotBounds plot_bounds(const ForestSpec& spec) {
  if (spec.plot) return bounds(*spec.plot);
  PlotBounds box{Vec2(INFINITY), Vec2(-INFINITY)};
  for (const InventoryTree& tree : spec.inventory) {
    box.lo_m = glm::min(box.lo_m, Vec2(tree.x_m, tree.y_m));
    box.hi_m = glm::max(box.hi_m, Vec2(tree.x_m, tree.y_m));
  }
  const double across = std::sqrt(static_cast<double>(spec.inventory.size()));
  const Vec2 margin = 0.5 * (box.hi_m - box.lo_m) / std::max(across - 1, 1.0) + 1e-3;
  return {box.lo_m - margin, box.hi_m + margin};
}

// About how many trees there will be with those around the plot.
double trees_with_strip(const ForestSpec& spec, double trees) {
  const PlotBounds box = plot_bounds(spec);
  const Vec2 size = box.hi_m - box.lo_m;
  const double plot_m2 = spec.plot ? area_m2(*spec.plot) : size.x * size.y;
  const double width_m = spec.surroundings_width_m > 0 ? spec.surroundings_width_m : kUsualWidth_m;
  switch (spec.surroundings) {
    case Surroundings::kNone:
      return trees;
    case Surroundings::kPeriodic:
      return trees * size.x * size.y / plot_m2;
    case Surroundings::kMirrored:
      return 9 * trees;
    case Surroundings::kSimilar:
      break;
  }
  return trees * (size.x + 2 * width_m) * (size.y + 2 * width_m) / plot_m2;
}

}  // namespace

void read_surroundings(const v1::ForestSpec& message, const std::string& field, std::uint64_t trees,
                       const Limits& limits, Violations& violations, ForestSpec& spec) {
  read_polygon(message, field + ".plot_polygon", violations, spec);
  spec.surroundings = kind_from_message(message.surroundings(), field + ".surroundings", violations);
  spec.surroundings_width_m = message.surroundings_width_m();
  const bool width_is_good =
      violations.number(field + ".surroundings_width_m", spec.surroundings_width_m, 0, kWidest_m);
  if (spec.surroundings == Surroundings::kNone || !width_is_good) return;
  if (spec.period) violations.add(field + ".period", "must be left out where the stand has surroundings");
  for (std::size_t i = 0; i < spec.inventory.size(); ++i)
    if (is_virtual(spec.inventory[i].id))
      violations.add(
          at(field + ".inventory", i) + ".id_tree",
          "must be at most " + std::to_string(kLargestTreeNumber) + " in a stand with surroundings");
  if (spec.inventory.empty()) return;
  const double all = trees_with_strip(spec, static_cast<double>(trees));
  if (all <= static_cast<double>(limits.trees_per_spec)) return;
  violations.add(field + ".surroundings_width_m",
                 "must keep the trees with those around within " + std::to_string(limits.trees_per_spec) +
                     ", got about " + std::to_string(static_cast<std::uint64_t>(std::min(all, 1e18))));
}

void fill_surroundings(const ForestSpec& spec, v1::ForestSpec& message) {
  message.set_surroundings(message_kind(spec.surroundings));
  message.set_surroundings_width_m(spec.surroundings_width_m);
  if (!spec.plot) return;
  for (const Vec2& corner : spec.plot->corners_m) {
    v1::PlotCorner& to = *message.add_plot_polygon();
    to.set_x_m(corner.x);
    to.set_y_m(corner.y);
  }
}

}  // namespace sunfleck
