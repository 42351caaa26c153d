#include "lighting/links/link_ends.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::links {
namespace {

constexpr double kStepsX = 32767.0, kStepsY = 65535.0;

double sign_of(double x) { return x < 0.0 ? -1.0 : 1.0; }

}  // namespace

std::uint32_t sky_end(const Vec3& direction) {
  const double length = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  double x = direction.x / length, y = direction.y / length;
  if (direction.z < 0.0) {
    const double folded = (1.0 - std::abs(y)) * sign_of(x);
    y = (1.0 - std::abs(x)) * sign_of(y);
    x = folded;
  }
  const auto steps = [](double a, double n) {
    return static_cast<std::uint32_t>(std::lround((0.5 * std::clamp(a, -1.0, 1.0) + 0.5) * n));
  };
  return kSkyBit | (steps(x, kStepsX) << 16) | steps(y, kStepsY);
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
