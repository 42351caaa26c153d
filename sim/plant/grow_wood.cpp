#include "sim/plant/grow_wood.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

double thickest_diameter(const Prototype& prototype) {
  double diameter = 0;
  for (const WoodSegment& s : prototype.wood) diameter = std::max(diameter, 2.0 * s.radius_from_m);
  return diameter;
}

void thicken_by_disused_pipes(std::vector<double>& radius, double exponent, double living_share) {
  const double foot = radius.empty() ? 1 : *std::max_element(radius.begin(), radius.end());
  for (double& r : radius) {
    const double share_of_pipes = std::pow(r / foot, exponent);
    r *= std::sqrt(living_share + (1 - living_share) * share_of_pipes);
  }
}

}  // namespace

double living_share(double dbh_m, double leaf_area_m2) {
  SUNFLECK_EXPECTS(dbh_m > 0 && leaf_area_m2 > 0);
  return std::min(kLivingShare, kMostLivingWood_m2_per_m2 * leaf_area_m2 / (0.25 * kPi * dbh_m * dbh_m));
}

std::vector<double> pipe_radii(const lsystem::Drawing& drawing, double exponent) {
  SUNFLECK_EXPECTS(exponent >= 2 && exponent <= 3);
  const auto& segments = drawing.segments;
  std::vector<double> pipes(segments.size(), 0);  // sum of r^e; one pipe has r = 1
  for (const lsystem::Organ& organ : drawing.organs)
    if (organ.segment >= 0) pipes[static_cast<std::size_t>(organ.segment)] += 1;
  for (std::size_t i = segments.size(); i-- > 0;) {
    if (pipes[i] == 0) pipes[i] = 1;
    const std::int32_t parent = segments[i].parent;
    SUNFLECK_EXPECTS(parent < static_cast<std::int32_t>(i));
    if (parent >= 0) pipes[static_cast<std::size_t>(parent)] += pipes[i];
  }
  for (double& p : pipes) p = std::pow(p, 1 / exponent);
  return pipes;
}

std::vector<WoodSegment> piped_wood(const lsystem::Drawing& drawing, double exponent, double living_share) {
  SUNFLECK_EXPECTS(living_share > 0 && living_share <= 1);
  std::vector<double> radius = pipe_radii(drawing, exponent);
  thicken_by_disused_pipes(radius, exponent, living_share);
  std::vector<double> thickest_child(radius.size(), 0);
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (const std::int32_t parent = drawing.segments[i].parent; parent >= 0)
      thickest_child[static_cast<std::size_t>(parent)] =
          std::max(thickest_child[static_cast<std::size_t>(parent)], radius[i]);
  std::vector<WoodSegment> wood;
  wood.reserve(radius.size());
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double narrowed = thickest_child[i] > 0 ? thickest_child[i] : 0.5 * radius[i];
    wood.push_back({Vec3f(drawing.segments[i].from_m), Vec3f(drawing.segments[i].to_m),
                    static_cast<float>(radius[i]), static_cast<float>(narrowed), 0});
  }
  return wood;
}

std::vector<bool> carrying_segments(const lsystem::Drawing& drawing, std::span<const std::size_t> organs) {
  std::vector<bool> carries(drawing.segments.size(), false);
  bool any = false;
  for (const std::size_t i : organs) {
    if (drawing.organs[i].segment < 0) continue;
    carries[static_cast<std::size_t>(drawing.organs[i].segment)] = any = true;
  }
  if (!any) return std::vector<bool>(carries.size(), true);
  for (std::size_t i = carries.size(); i-- > 0;)
    if (const std::int32_t parent = drawing.segments[i].parent; carries[i] && parent >= 0)
      carries[static_cast<std::size_t>(parent)] = true;
  return carries;
}

void scale_wood_to_dbh(Prototype& prototype, double dbh_m) {
  prototype.stated_dbh_m = 0;
  double diameter = measure(prototype).dbh_m;
  if (diameter <= 0) diameter = thickest_diameter(prototype);
  prototype.stated_dbh_m = dbh_m;
  if (diameter <= 0) return;
  const auto factor = static_cast<float>(dbh_m / diameter);
  for (WoodSegment& s : prototype.wood) {
    s.radius_from_m *= factor;
    s.radius_to_m *= factor;
  }
}

}  // namespace sunfleck
