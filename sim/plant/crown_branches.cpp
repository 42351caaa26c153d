#include "sim/plant/crown_branches.h"

#include <algorithm>
#include <cmath>

#include "sim/plant/crown_shape.h"

namespace sunfleck {
namespace {

constexpr double kUsualLengthM = 1.0, kUsualRadiusM = 0.01;
constexpr double kTaper = 0.3;  // thicker at the foot and thinner at the tip by this share

// Away from the stem, half of the way up.
Vec3 branch_direction(const Vec3& tip_m, RandomStream& random) {
  const double away_m = std::hypot(tip_m.x, tip_m.y), turn = random.uniform(0.0, 2.0 * kPi);
  const Vec2 away = away_m > 1e-6 ? Vec2(tip_m) / away_m : Vec2(std::cos(turn), std::sin(turn));
  return Vec3(away, 1.0) * std::sqrt(0.5);
}

}  // namespace

std::vector<WoodSegment> crown_branches(const CrownShape& crown, const CrownFill& fill) {
  const double wood_m2 = fill.branch_share * fill.leaf_area_m2;
  if (!(wood_m2 > 0.0)) return {};
  const double width_m = 0.25 * (crown.radius_nesw_m[0] + crown.radius_nesw_m[1] + crown.radius_nesw_m[2] +
                                 crown.radius_nesw_m[3]);
  const double length_m = std::min({kUsualLengthM, 0.5 * width_m, 0.5 * (crown.height_m - crown.base_m)});
  const double usual_m2 = kPi * kUsualRadiusM * length_m;  // half the side of a rod
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(wood_m2 / usual_m2)));
  const double radius_m = wood_m2 / (kPi * length_m * static_cast<double>(count));
  const CrownSampler sampler(crown, fill.rim_power, fill.height_power);
  std::vector<WoodSegment> rods;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(fill.seed, i, RandomPurpose::kCrownBranches);
    const Vec3 tip_m =
        sampler.sample((static_cast<double>(i) + random.uniform()) / static_cast<double>(count), random);
    const Vec3 foot_m = tip_m - length_m * branch_direction(tip_m, random);
    if (foot_m.z < 0.0) continue;
    rods.push_back({Vec3f(foot_m), Vec3f(tip_m), static_cast<float>((1.0 + kTaper) * radius_m),
                    static_cast<float>((1.0 - kTaper) * radius_m), 0});
  }
  return rods;
}

}  // namespace sunfleck
