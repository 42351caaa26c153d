#include "lighting/shade/bough_linear.h"

#include <cmath>

namespace sunfleck {
namespace {

// Opacities of the two halves for a direction: the near one is crossed by the needles at k+, the far one at
// k-.
struct HalfOpacities {
  double front = 0, rear = 0;
};

HalfOpacities half_opacities(const Bough& bough, const Vec3& direction) {
  const NeedleCone& cone = bough.cone;
  const double radius = cone.length * std::sin(cone.aperture_rad);
  const double a = kPi * radius * cone_cover(cone) / (4 * bough.spacing);
  const double cot_aperture = 1 / std::tan(cone.aperture_rad);
  const double cot_zenith = direction.z / std::hypot(direction.x, direction.y);
  return {a * std::abs(cot_aperture - cot_zenith), a * std::abs(cot_aperture + cot_zenith)};
}

double mean_diffuse(const ConeLight& part) { return part.covered > 0 ? part.reflected / part.covered : 0; }

}  // namespace

double cone_cover(const NeedleCone& cone) {
  return 2 * cone.needles * cone.radius / (kPi * cone.length * std::sin(cone.aperture_rad));
}

SweptLengths swept_lengths(double between_rad) {
  const double c = std::cos(between_rad);
  return {(1 - c) / 3, 1 - c / 3, (1 + c) / 3, 1 + c / 3};
}

BoughLight bough_light_linear(const Bough& bough, const Vec3& to_viewer, const Vec3& to_light) {
  const HalfOpacities view = half_opacities(bough, to_viewer), light = half_opacities(bough, to_light);
  const double between = std::atan2(to_viewer.y, to_viewer.x) - std::atan2(to_light.y, to_light.x);
  const SweptLengths swept = swept_lengths(between);
  const LinearConeLight cone = cone_light_linear(bough.cone, to_viewer, to_light);
  constexpr double k = 8 / (3 * kPi * kPi);
  const double front =
      mean_diffuse(cone.front) * view.front *
      (1 -
       k * (2 * view.front + 3 * (swept.front_in_rear * light.rear + swept.front_in_front * light.front)));
  const double rear = mean_diffuse(cone.rear) * view.rear *
                      (1 - k * (4 * view.front + 2 * view.rear +
                                3 * (swept.rear_in_rear * light.rear + swept.rear_in_front * light.front)));
  return {view.front + view.rear, front + rear};
}

}  // namespace sunfleck
