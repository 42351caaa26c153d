#include "lighting/render/leaf_outline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr double kStalk = 0.1, kStalkWidth = 0.035;  // of length and width

double ovate_width(double s) {
  constexpr double kAtWidest = 0.38198;  // makes the largest width 1
  return std::pow(s, 0.55) * std::pow(1.0 - s, 0.9) / kAtWidest;
}

double lobed_width(double s) {
  const double body = std::pow(s, 0.75) * std::pow(1.0 - s, 0.42) / 0.44846;
  return body * (0.76 + 0.24 * std::cos(2.0 * kPi * (4.0 * s - 0.05)));
}

double needle_width(double s) {
  const double from_end = std::min(s, 1.0 - s);
  return from_end < 0.06 ? std::sqrt(1.0 - std::pow(1.0 - from_end / 0.06, 2)) : 1.0;
}

// Half the width of the outline at x, relative to half the width of its box.
double half_width(LeafOutline outline, double x) {
  const double t = 0.5 * (x + 1.0);
  if (t < 0.0 || t > 1.0) return 0.0;
  if (outline == LeafOutline::kNeedle) return needle_width(t);
  const double s = (t - kStalk) / (1.0 - kStalk);
  const double blade = s <= 0.0 ? 0.0 : outline == LeafOutline::kLobed ? lobed_width(s) : ovate_width(s);
  return std::min(1.0, t < 0.5 ? std::max(blade, kStalkWidth) : blade);
}

// 1 on a rib, 0 between: the middle rib and seven pairs of side ribs that lean towards the tip.
double ribs(LeafOutline outline, const Vec2& at) {
  const double middle = std::exp(-std::pow(at.y / 0.035, 2));
  if (outline == LeafOutline::kNeedle) return middle;
  const double along = 7.0 * (0.5 * (at.x + 1.0) - 0.22 * std::abs(at.y));
  const double side = std::exp(-std::pow((along - std::round(along)) / 0.07, 2));
  return std::max(middle, 0.6 * side);
}

constexpr double kRibReflects = 0.5, kRibStops = 0.6;

double mean_ribs(LeafOutline outline) {
  constexpr int kSide = 512;
  double sum = 0.0;
  int inside = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const Vec2 at(2.0 * (i + 0.5) / kSide - 1.0, 2.0 * (j + 0.5) / kSide - 1.0);
      if (!inside_leaf(outline, at)) continue;
      sum += ribs(outline, at);
      ++inside;
    }
  return sum / inside;
}

double share_by_midpoints(LeafOutline outline) {
  constexpr int kSteps = 1 << 16;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += half_width(outline, 2.0 * (i + 0.5) / kSteps - 1.0);
  return sum / kSteps;
}

struct OutlineSums {
  double share, ribs;
};

const OutlineSums& sums_of(LeafOutline outline) {
  SUNFLECK_EXPECTS(outline >= LeafOutline::kOvate);
  static const auto table = [] {
    std::array<OutlineSums, 3> sums{};
    for (const LeafOutline o : {LeafOutline::kOvate, LeafOutline::kLobed, LeafOutline::kNeedle})
      sums[static_cast<std::size_t>(o) - 2] = {share_by_midpoints(o), mean_ribs(o)};
    return sums;
  }();
  return table[static_cast<std::size_t>(outline) - 2];
}

}  // namespace

std::string to_string(LeafOutline outline) {
  static const std::array<const char*, 5> names = {"by_species", "as_modelled", "ovate", "lobed", "needle"};
  return names[static_cast<std::size_t>(outline)];
}

LeafOutline outline_of(const std::string& material) {
  const auto is_one_of = [&](std::initializer_list<const char*> genera) {
    return std::any_of(genera.begin(), genera.end(),
                       [&](const char* genus) { return material.starts_with(genus); });
  };
  if (is_one_of({"Quercus"})) return LeafOutline::kLobed;
  if (is_one_of({"Pinus", "Picea", "Abies", "Larix", "Pseudotsuga"})) return LeafOutline::kNeedle;
  return LeafOutline::kOvate;
}

bool inside_leaf(LeafOutline outline, const Vec2& at) {
  SUNFLECK_EXPECTS(outline != LeafOutline::kBySpecies);
  if (outline == LeafOutline::kAsModelled) return true;
  return std::abs(at.y) <= half_width(outline, at.x);
}

double outline_share(LeafOutline outline) { return sums_of(outline).share; }

double natural_aspect(LeafOutline outline) {
  if (outline == LeafOutline::kNeedle) return 10.0;
  return outline == LeafOutline::kLobed ? 1.7 : 1.5;
}

LeafPattern vein_pattern(LeafOutline outline, const Vec2& at) {
  const double rib = ribs(outline, at), mean = sums_of(outline).ribs;
  return {(1.0 + kRibReflects * rib) / (1.0 + kRibReflects * mean),
          (1.0 - kRibStops * rib) / (1.0 - kRibStops * mean)};
}

}  // namespace sunfleck
