// Rings of equal solid angle; see sample_directions.h.
#include "lighting/slab/sample_directions.h"

#include <cmath>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

Vec3 direction_at(double cos_zenith, double azimuth_rad) {
  const double sin_zenith = std::sqrt(std::max(0.0, 1.0 - cos_zenith * cos_zenith));
  return {sin_zenith * std::cos(azimuth_rad), sin_zenith * std::sin(azimuth_rad), cos_zenith};
}

int wrapped(int step, int steps) { return ((step % steps) + steps) % steps; }

}  // namespace

SampleDirections::SampleDirections(int count, double base_yaw_rad)
    : base_yaw_rad_(base_yaw_rad), steps_(count == 22 ? 20 : 16) {
  SUNFLECK_EXPECTS(count == 16 || count == 22);
  // Each axis stands for the same share of the hemisphere; a ring lies at the mean cosine of its share.
  if (count == 22) {
    add_ring(1.0, 1, 0.0);
    add_ring(7.5 / 11.0, 5, 0.0);
    add_ring(2.5 / 11.0, 5, 0.1);
  } else {
    add_ring(0.75, 4, 0.0);
    add_ring(0.25, 4, 0.125);
  }
}

void SampleDirections::add_ring(double cos_zenith, int members, double offset_turns) {
  for (int i = 0; i < members; ++i) {
    axes_.push_back({cos_zenith, members, i, offset_turns, keys_});
    const double turns = offset_turns + static_cast<double>(i) / members;
    upward_.push_back(direction_at(cos_zenith, base_yaw_rad_ + 2.0 * kPi * turns));
  }
  keys_ += members == 1 ? 1 : static_cast<std::size_t>(steps_);
}

int SampleDirections::step_of(double yaw_rad) const {
  const double turns = (yaw_rad - base_yaw_rad_) / (2.0 * kPi);
  return wrapped(static_cast<int>(std::lround((turns - std::floor(turns)) * steps_)), steps_);
}

std::size_t SampleDirections::key(std::size_t axis, int step) const {
  const Axis& a = axes_[axis];
  if (a.members == 1) return a.first_key;
  return a.first_key + static_cast<std::size_t>(wrapped(a.index * (steps_ / a.members) - step, steps_));
}

Vec3 SampleDirections::local(std::size_t axis, int step) const {
  const Axis& a = axes_[axis];
  const double turns = a.offset_turns + static_cast<double>(key(axis, step) - a.first_key) / steps_;
  return direction_at(a.cos_zenith, 2.0 * kPi * turns);
}

}  // namespace sunfleck
