#include "sim/plant/crown_shape.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr int kMostRejections = 10000;  // never reached: at power 20 one place in about 100 stays

enum { kNorth, kEast, kSouth, kWest };

// Horizontal semi-axes of the quadrant a point lies in, with the signs of the quadrant.
Vec2 quadrant_axes_m(const CrownShape& crown, bool east, bool north) {
  const auto& r = crown.radius_nesw_m;
  return {east ? r[kEast] : -r[kWest], north ? r[kNorth] : -r[kSouth]};
}

// In the positive octant of the unit ball: direction uniform on the sphere; distance r with density r^2
// r^rim.
Vec3 sample_ball_octant(double rim_power, RandomStream& random) {
  const double z = random.uniform();
  const double azimuth_rad = random.uniform(0.0, 0.5 * kPi);
  const double u = random.uniform(),
               radius = rim_power > 0.0 ? std::pow(u, 1.0 / (3.0 + rim_power)) : std::cbrt(u);
  const double horizontal = std::sqrt(1.0 - z * z);
  return radius * Vec3(horizontal * std::cos(azimuth_rad), horizontal * std::sin(azimuth_rad), z);
}

}  // namespace

std::array<CrownEighth, 8> crown_eighths(const CrownShape& crown) {
  std::array<CrownEighth, 8> eighths;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec2 axes = quadrant_axes_m(crown, i & 1u, i & 2u);
    const double z = (i & 4u) ? crown.height_m - crown.widest_m : crown.base_m - crown.widest_m;
    const Vec3 semi(axes.x, axes.y, z);
    eighths[i] = {semi, kPi / 6.0 * std::abs(semi.x * semi.y * semi.z)};  // 4 pi/3 abc / 8
  }
  return eighths;
}

double crown_volume_m3(const CrownShape& crown) {
  double volume_m3 = 0.0;
  for (const CrownEighth& eighth : crown_eighths(crown)) volume_m3 += eighth.volume_m3;
  return volume_m3;
}

bool inside_crown(const CrownShape& crown, const Vec3& point_m, double tolerance) {
  const Vec2 axes = quadrant_axes_m(crown, point_m.x >= 0.0, point_m.y >= 0.0);
  const double above_m = point_m.z - crown.widest_m;
  const double z_axis_m = above_m >= 0.0 ? crown.height_m - crown.widest_m : crown.widest_m - crown.base_m;
  if (z_axis_m <= 0.0)
    return std::abs(above_m) <= tolerance && inside_crown(crown, {point_m.x, point_m.y, crown.widest_m});
  const Vec3 scaled(point_m.x / axes.x, point_m.y / axes.y, above_m / z_axis_m);
  return glm::dot(scaled, scaled) <= (1.0 + tolerance) * (1.0 + tolerance);
}

CrownSampler::CrownSampler(const CrownShape& crown, double rim_power, double height_power)
    : base_m_(crown.base_m),
      length_m_(crown.height_m - crown.base_m),
      widest_m_(crown.widest_m),
      rim_power_(rim_power),
      height_power_(height_power),
      eighths_(crown_eighths(crown)),
      volume_to_here_m3_{} {
  double sum_m3 = 0.0;
  for (std::size_t i = 0; i < eighths_.size(); ++i) volume_to_here_m3_[i] = sum_m3 += eighths_[i].volume_m3;
}

// By rejection: a place at a share t of the crown's length stays with the chance t^height_power.
Vec3 CrownSampler::sample(double share, RandomStream& random) const {
  Vec3 place = even_with_rim(share, random);
  if (!(height_power_ > 0.0)) return place;
  for (int i = 0; i < kMostRejections; ++i) {
    const double t = std::clamp((place.z - base_m_) / length_m_, 0.0, 1.0);
    if (random.uniform() < std::pow(t, height_power_)) break;
    place = even_with_rim(random.uniform(), random);
  }
  return place;
}

Vec3 CrownSampler::even_with_rim(double share, RandomStream& random) const {
  const double volume_m3 = share * volume_to_here_m3_.back();
  const auto found = std::upper_bound(volume_to_here_m3_.begin(), volume_to_here_m3_.end() - 1, volume_m3);
  const auto& eighth = eighths_[static_cast<std::size_t>(found - volume_to_here_m3_.begin())];
  return Vec3(0.0, 0.0, widest_m_) + eighth.semi_axes_m * sample_ball_octant(rim_power_, random);
}

void validate(const CrownShape& crown, const std::string& where) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0 && v < 1e4; };
  for (std::size_t i = 0; i < 4; ++i)
    if (!positive(crown.radius_nesw_m[i]))
      throw_invalid(where + std::string(": crown radius ") + "NESW"[i], "is no radius",
                    "give a length in metres above 0");
  if (!positive(crown.height_m))
    throw_invalid(where + ": height", "is no height", "give a length in metres above 0");
  if (!(crown.dbh_m >= 0.0 && crown.dbh_m < 100.0))
    throw_invalid(where + ": dbh", "is no stem diameter", "give a diameter in metres, 0 for no stem");
  if (!(crown.base_m >= 0.0 && crown.base_m < crown.height_m))
    throw_invalid(where + ": crown base", "is not between the ground and the top",
                  "give a height in metres from 0 to below the tree's height");
  if (!(crown.widest_m >= crown.base_m && crown.widest_m <= crown.height_m))
    throw_invalid(where + ": height of the largest radius", "is not within the crown",
                  "give a height in metres from the crown base to the top");
}

}  // namespace sunfleck
