#include "lighting/shade/cone.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/shade/arc_series.h"
#include "lighting/shade/gauss_points.h"
#include "lighting/shade/needle.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

Vec3 needle_axis(const NeedleCone& cone, double azimuth_rad) {
  const double s = std::sin(cone.aperture_rad);
  return {s * std::cos(azimuth_rad), s * std::sin(azimuth_rad), std::cos(cone.aperture_rad)};
}

double azimuth_round_z(const Vec3& d) { return std::atan2(d.y, d.x); }

// How the cone's surface looks from one direction.
struct ConeSide {
  double azimuth_rad = 0, half_rad = 0;    // middle and half width of the front part
  double front_area = 0, rear_area = 0;    // projected areas of the two parts of the surface
  double front_cover = 0, rear_cover = 0;  // projected areas that needles cover on them
  double through_front = 1;                // light that reaches the rear part
  bool front(double azimuth) const {
    return std::abs(std::remainder(azimuth - azimuth_rad, 2 * kPi)) < half_rad;
  }
};

// Share of a needle that is not hidden by its neighbours near the apex: cover s0 / s along the slant s,
// saturated at 1.
double share_seen(const NeedleCone& cone, const Vec3& direction, double azimuth_rad, double sine) {
  const double c = std::cos(cone.aperture_rad), s = std::sin(cone.aperture_rad);
  const Vec3 outwards(c * std::cos(azimuth_rad), c * std::sin(azimuth_rad), -s);
  const double facing = std::abs(glm::dot(outwards, direction));
  const double full = cone.needles * cone.radius * sine;  // s0 * pi sin(aperture) |n.V|
  const double unit = kPi * s * facing * cone.length;
  if (!(full > 0)) return 1;  // seen end on: covers nothing
  return full < unit ? 1 - full / (2 * unit) : unit / (2 * full);
}

// Sums term(azimuth) over [from, to], panels of at most a quarter turn.
template <class Term>
double arc_integral(double from, double to, const Term& term) {
  const int panels = std::max(1, static_cast<int>(std::ceil((to - from) / (kPi / 2) - 1e-9)));
  const double width = (to - from) / panels;
  double sum = 0;
  for (int p = 0; p < panels; ++p)
    for (std::size_t i = 0; i < kGauss8.at.size(); ++i)
      sum += kGauss8.weight[i] * width * term(from + (p + kGauss8.at[i]) * width);
  return sum;
}

// Apparent width of all needles per radian of azimuth, times their length: N 2 r l / (2 pi).
double needle_area_per_rad(const NeedleCone& cone) { return cone.needles * cone.radius * cone.length / kPi; }

double cover(const NeedleCone& cone, const Vec3& direction, double from, double to) {
  return needle_area_per_rad(cone) * arc_integral(from, to, [&](double azimuth) {
           const double along = glm::dot(needle_axis(cone, azimuth), direction);
           const double sine = std::sqrt(std::max(0.0, 1 - along * along));
           return sine * share_seen(cone, direction, azimuth, sine);
         });
}

ConeSide cone_side(const NeedleCone& cone, const Vec3& direction) {
  ConeSide side;
  const double zenith = zenith_of(direction);
  side.azimuth_rad = azimuth_round_z(direction);
  side.half_rad = front_half_angle_rad(cone.aperture_rad, zenith);
  const double s = std::sin(cone.aperture_rad), c = std::cos(cone.aperture_rad);
  const double base = kPi * cone.length * cone.length * s * s * direction.z;
  side.front_area =
      std::max(0.0, cone.length * cone.length * s *
                        (c * std::sin(zenith) * std::sin(side.half_rad) - s * direction.z * side.half_rad));
  side.rear_area = std::max(0.0, side.front_area + base);
  const double middle = side.azimuth_rad, half = side.half_rad;
  side.front_cover = std::min(side.front_area, cover(cone, direction, middle - half, middle + half));
  side.rear_cover = std::min(side.rear_area, cover(cone, direction, middle + half, middle - half + 2 * kPi));
  if (side.front_area > 0 && side.rear_area > 0)
    side.through_front =
        1 - side.front_cover / side.front_area * std::min(1.0, side.front_area / side.rear_area);
  return side;
}

// Where the parts of either side begin and end, ascending over one turn.
std::array<double, 5> part_borders(const ConeSide& view, const ConeSide& light) {
  std::array<double, 5> at{view.azimuth_rad - view.half_rad, view.azimuth_rad + view.half_rad,
                           light.azimuth_rad - light.half_rad, light.azimuth_rad + light.half_rad, 0};
  for (int i = 0; i < 4; ++i) at[i] -= 2 * kPi * std::floor(at[i] / (2 * kPi));
  std::sort(at.begin(), at.begin() + 4);
  at[4] = at[0] + 2 * kPi;
  return at;
}

}  // namespace

void validate(const NeedleCone& cone, const char* where) {
  if (cone.needles < 1) throw_invalid(where, "no needles", "at least 1");
  if (!(cone.length > 0) || !(cone.radius > 0) || !std::isfinite(cone.length) || !std::isfinite(cone.radius))
    throw_invalid(where, "needle length or radius is not a positive number", "both > 0");
  if (!(cone.aperture_rad > 0 && cone.aperture_rad < kPi / 2))
    throw_invalid(where, "aperture outside (0, pi/2)", "the angle between branch and needle");
}

double front_half_angle_rad(double aperture_rad, double direction_zenith_rad) {
  if (direction_zenith_rad <= aperture_rad) return 0;
  if (direction_zenith_rad >= kPi - aperture_rad) return kPi;
  return std::acos(std::clamp(std::tan(aperture_rad) / std::tan(direction_zenith_rad), -1.0, 1.0));
}

ConeLight cone_light(const NeedleCone& cone, const Vec3& to_viewer, const Vec3& to_light) {
  const ConeSide view = cone_side(cone, to_viewer), light = cone_side(cone, to_light);
  ConeLight result;
  result.covered = view.front_cover + view.rear_cover;
  if (view.front_area > 0 && view.rear_area > 0)  // what both parts cover counts once
    result.covered -= view.front_cover / view.front_area * (view.rear_cover / view.rear_area) *
                      std::min(view.front_area, view.rear_area);
  const std::array<double, 5> border = part_borders(view, light);
  for (int part = 0; part < 4; ++part) {
    const double middle = 0.5 * (border[part] + border[part + 1]);
    const double reaches =
        (view.front(middle) ? 1 : view.through_front) * (light.front(middle) ? 1 : light.through_front);
    result.reflected += reaches * needle_area_per_rad(cone) *
                        arc_integral(border[part], border[part + 1], [&](double azimuth) {
                          const NeedleAngles<double> angles =
                              needle_angles(needle_axis(cone, azimuth), to_viewer, to_light);
                          return angles.sin_view * share_seen(cone, to_viewer, azimuth, angles.sin_view) *
                                 needle_diffuse(angles);
                        });
  }
  return result;
}

LinearConeLight cone_light_linear(const NeedleCone& cone, const Vec3& to_viewer, const Vec3& to_light) {
  std::array<double, kArcSamples> width{}, shade{};
  for (int i = 0; i < kArcSamples; ++i) {
    const NeedleAngles<double> angles =
        needle_angles(needle_axis(cone, 2 * kPi * i / kArcSamples), to_viewer, to_light);
    width[i] = angles.sin_view;
    shade[i] = angles.sin_view * needle_diffuse(angles);
  }
  const ArcSeries widths(width), shades(shade);
  const double middle = azimuth_round_z(to_viewer), area = needle_area_per_rad(cone);
  const double half = front_half_angle_rad(cone.aperture_rad, zenith_of(to_viewer));
  return {
      {area * widths.integral(middle, half), area * shades.integral(middle, half)},
      {area * widths.integral(middle + kPi, kPi - half), area * shades.integral(middle + kPi, kPi - half)}};
}

}  // namespace sunfleck
