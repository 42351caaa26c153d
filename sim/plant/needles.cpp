#include "sim/plant/needles.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr double kGoldenAngle_rad = 2.399963229728653;
constexpr double kTwigShare = 0.08;    // needles begin at this share of the shoot's radius from its axis
constexpr double kCombedShare = 0.25;  // how much of its way out of the plane a combed needle keeps
constexpr double kFascicleSpread_rad = 0.2;  // half the angle between the two needles of a pair
constexpr std::uint32_t kTuft = 6;  // from so many needles on, a fascicle is a tuft round a short shoot

// The shoot's frame and the needle's size in it.
struct ShootFrame {
  Vec3 foot_m, along, left, up;
  double length_m, radius_m, needle_m;

  Vec3 outward(double azimuth_rad) const { return std::cos(azimuth_rad) * left + std::sin(azimuth_rad) * up; }
};

ShootFrame frame_of(const FoliageElement& shoot, const FoliageTemplate& foliage) {
  ShootFrame f;
  const Vec3 u(shoot.half_u_m), v(shoot.half_v_m);
  f.length_m = 2 * glm::length(u);
  f.radius_m = glm::length(v);
  f.along = glm::normalize(u);
  f.left = glm::normalize(v - f.along * glm::dot(v, f.along));
  f.up = glm::cross(f.along, f.left);
  f.foot_m = Vec3(shoot.centre_m) - u;
  f.needle_m = std::min(foliage.needle_length_m * f.length_m / foliage.shoot_length_m, 0.9 * f.length_m);
  return f;
}

// Left and right in the plane of the spray, the upper ones lifted a little.
double combed(double azimuth_rad) {
  const double out = std::asin(std::sin(azimuth_rad));
  return std::cos(azimuth_rad) >= 0 ? kCombedShare * out : kPi - kCombedShare * out;
}

// A needle that leans towards the tip: it goes out by the rest of the radius.
Needle leaning(const ShootFrame& f, double share, double azimuth_rad) {
  const double out_m = std::min((1 - kTwigShare) * f.radius_m, 0.98 * f.needle_m);
  const double forward_m = std::sqrt(f.needle_m * f.needle_m - out_m * out_m);
  const Vec3 outward = f.outward(azimuth_rad);
  const Vec3 base = f.foot_m + share * (f.length_m - forward_m) * f.along + kTwigShare * f.radius_m * outward;
  return {Vec3f(base), Vec3f(base + out_m * outward + forward_m * f.along), 0};
}

// How far a needle of a tuft may go aside before its tip leaves the cylinder, as a share of its sideways
// part: out by r0 + l cos(tilt) already, it has sqrt(r^2 - that^2) left across the shoot; along it there is
// room.
double most_across(const ShootFrame& f, double tilt_rad) {
  const double out_m = kTwigShare * f.radius_m + f.needle_m * std::cos(tilt_rad);
  const double room_m2 = f.radius_m * f.radius_m - out_m * out_m;
  return room_m2 <= 0 ? 0 : std::min(1.0, std::sqrt(room_m2) / (f.needle_m * std::sin(tilt_rad)));
}

// A needle of a tuft at `foot_m` along: `tilt` from the short shoot, towards `turn` round it; turned over
// where it would reach beyond an end of the shoot.
Needle spread(const ShootFrame& f, double foot_m, double azimuth_rad, double tilt_rad, double turn_rad) {
  const Vec3 outward = f.outward(azimuth_rad), sideways = glm::cross(f.along, outward);
  const double most = most_across(f, tilt_rad), across = std::clamp(std::sin(turn_rad), -most, most);
  const double side_m = f.needle_m * std::sin(tilt_rad);
  double forward_m = side_m * std::sqrt(1 - across * across) * (std::cos(turn_rad) < 0 ? -1 : 1);
  if (foot_m + forward_m > f.length_m || foot_m + forward_m < 0) forward_m = -forward_m;
  const Vec3 base = f.foot_m + foot_m * f.along + kTwigShare * f.radius_m * outward;
  const Vec3 way =
      f.needle_m * std::cos(tilt_rad) * outward + forward_m * f.along + side_m * across * sideways;
  return {Vec3f(base), Vec3f(base + way), 0};
}

// Needles over the half sphere round the short shoot, none steeper than the cylinder is high.
void add_tuft(const ShootFrame& f, double foot_m, double azimuth_rad, std::uint32_t count,
              RandomStream& random, std::vector<Needle>& needles) {
  const double steepest = std::acos(std::min(1.0, (1 - kTwigShare) * f.radius_m / f.needle_m));
  for (std::uint32_t k = 0; k < count; ++k) {
    const double level = (k + random.uniform()) / count;
    const double tilt = std::max(std::acos(1 - level), steepest);
    needles.push_back(spread(f, foot_m, azimuth_rad, tilt, kGoldenAngle_rad * k));
  }
}

// The needles of one fascicle: a tuft, or one or a few beside each other.
void add_fascicle(const ShootFrame& f, const FoliageTemplate& foliage, double share, double azimuth_rad,
                  std::uint32_t count, RandomStream& random, std::vector<Needle>& needles) {
  const std::uint32_t each = foliage.needles_per_fascicle;
  if (each >= kTuft) return add_tuft(f, share * f.length_m, azimuth_rad, count, random, needles);
  for (std::uint32_t k = 0; k < count; ++k) {
    const double turned = azimuth_rad + (each > 1 ? kFascicleSpread_rad * (2.0 * k / (each - 1) - 1) : 0);
    needles.push_back(leaning(f, share, foliage.needles_combed ? combed(turned) : turned));
  }
}

}  // namespace

std::vector<NeedleKind> needle_kinds(const SpeciesLibrary& library) {
  std::vector<NeedleKind> kinds;
  for (const Species& s : library.all())
    if (s.foliage.kind == FoliageKind::kShoot) kinds.push_back({s.material.name, s.foliage});
  return kinds;
}

const NeedleKind* find_needle_kind(std::span<const NeedleKind> kinds, const std::string& material) {
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const NeedleKind& k) { return k.material == material; });
  return found == kinds.end() ? nullptr : &*found;
}

std::size_t needle_count(const FoliageTemplate& foliage) {
  return static_cast<std::size_t>(std::max(1.0, std::round(foliage.needles_per_m * foliage.shoot_length_m)));
}

void expand_needles(const FoliageElement& shoot, const FoliageTemplate& foliage, std::uint64_t seed,
                    std::uint64_t number, std::vector<Needle>& needles) {
  SUNFLECK_EXPECTS(shoot.shape == ElementShape::kShoot && foliage.kind == FoliageKind::kShoot);
  const ShootFrame f = frame_of(shoot, foliage);
  const std::size_t count = needle_count(foliage), begin = needles.size();
  const std::uint32_t each = foliage.needles_per_fascicle;
  const std::size_t fascicles = (count + each - 1) / each;
  RandomStream random(seed, number, RandomPurpose::kNeedles);
  const double start = random.uniform(0, 2 * kPi);
  for (std::size_t i = 0; i < fascicles; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(fascicles);
    const double azimuth = start + kGoldenAngle_rad * static_cast<double>(i);
    const auto here = static_cast<std::uint32_t>(std::min<std::size_t>(each, count - i * each));
    add_fascicle(f, foliage, share, azimuth, here, random, needles);
  }
  const auto radius_m = static_cast<float>(shoot.area_m2 / (kPi * f.needle_m * static_cast<double>(count)));
  for (std::size_t i = begin; i < needles.size(); ++i) needles[i].radius_m = radius_m;
}

}  // namespace sunfleck
