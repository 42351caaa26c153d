#include "sim/plant/crown_stem.h"

#include <algorithm>

namespace sunfleck {
namespace {

constexpr double kBreastHeight_m = 1.3;
constexpr double kLargestFlare = 1.25;

WoodSegment segment(const CrownShape& crown, double from_m, double to_m) {
  WoodSegment wood;
  wood.from_m = Vec3f(0, 0, from_m);
  wood.to_m = Vec3f(0, 0, to_m);
  wood.radius_from_m = static_cast<float>(stem_radius_m(crown, from_m));
  wood.radius_to_m = static_cast<float>(stem_radius_m(crown, to_m));
  return wood;
}

}  // namespace

double stem_radius_m(const CrownShape& crown, double height_m) {
  const double radius_m = 0.5 * crown.dbh_m;
  const double to_top_m = std::max(0.0, crown.height_m - height_m);
  if (crown.height_m <= kBreastHeight_m) return radius_m * std::min(1.0, to_top_m / crown.height_m);
  const double cone = to_top_m / (crown.height_m - kBreastHeight_m);
  if (height_m >= kBreastHeight_m) return radius_m * cone;
  const double foot = std::min(kLargestFlare, crown.height_m / (crown.height_m - kBreastHeight_m));
  return radius_m * (foot + (1.0 - foot) * std::max(0.0, height_m) / kBreastHeight_m);
}

std::vector<WoodSegment> crown_stem(const CrownShape& crown) {
  if (crown.dbh_m <= 0.0) return {};
  if (crown.height_m <= kBreastHeight_m) return {segment(crown, 0.0, crown.height_m)};
  return {segment(crown, 0.0, kBreastHeight_m), segment(crown, kBreastHeight_m, crown.height_m)};
}

}  // namespace sunfleck
