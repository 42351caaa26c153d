#include "lighting/links/link_ends.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::links {
namespace {

constexpr double kStepsX = 32767.0, kStepsY = 65535.0;

double sign_of(double x) { return x < 0.0 ? -1.0 : 1.0; }

}  // namespace

namespace {

// The nearest step, or for `inwards` the one nearer to the middle of the map.
std::uint32_t step_of(double a, double n, bool inwards) {
  const double at = (0.5 * std::clamp(a, -1.0, 1.0) + 0.5) * n;
  return static_cast<std::uint32_t>(!inwards ? std::lround(at) : a > 0.0 ? std::floor(at) : std::ceil(at));
}

std::uint32_t end_at(double x, double y, bool inwards) {
  return kSkyBit | (step_of(x, kStepsX, inwards) << 16) | step_of(y, kStepsY, inwards);
}

}  // namespace

std::uint32_t sky_end(const Vec3& direction) {
  const double length = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  double x = direction.x / length, y = direction.y / length;
  if (direction.z < 0.0) {
    const double folded = (1.0 - std::abs(y)) * sign_of(x);
    y = (1.0 - std::abs(x)) * sign_of(y);
    x = folded;
  }
  const std::uint32_t nearest = end_at(x, y, false);
  // What looks up must not come back from below the horizon, where there is no sky.
  return direction.z > 0.0 && !(sky_direction(nearest).z > 0.0) ? end_at(x, y, true) : nearest;
}

Vec3 sky_direction(std::uint32_t end) {
  double x = 2.0 * ((end >> 16) & 0x7FFFu) / kStepsX - 1.0, y = 2.0 * (end & 0xFFFFu) / kStepsY - 1.0;
  const double z = 1.0 - std::abs(x) - std::abs(y);
  if (z < 0.0) {
    const double folded = (1.0 - std::abs(y)) * sign_of(x);
    y = (1.0 - std::abs(x)) * sign_of(y);
    x = folded;
  }
  return glm::normalize(Vec3(x, y, z));
}

}  // namespace sunfleck::links
