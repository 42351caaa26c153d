// The few directions in which depths are kept ([SPP] section 5.1: 16 or 22): axes on rings around the
// vertical, all with the same solid angle, each taken upwards and downwards.
//
// Instances are turned by any yaw, but their prototypes' maps only exist for a few local directions: the yaw
// is rounded to a quarter of the azimuth between two directions of a ring. The rings are turned with the yaw
// of the forest's first instance, so that a lone tree is never rounded and a turned forest gives the same
// answer.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

class SampleDirections {
 public:
  // `count` is 16 or 22; `base_yaw_rad` turns all rings.
  SampleDirections(int count, double base_yaw_rad);

  std::size_t axes() const { return axes_.size(); }            // half of the directions
  std::size_t directions() const { return 2 * axes_.size(); }  // upward ones first, then their opposites
  Vec3 direction(std::size_t j) const { return j < axes() ? upward_[j] : -upward_[j - axes()]; }
  const Vec3& upward(std::size_t axis) const { return upward_[axis]; }

  // Steps a full turn is rounded to, and the step of a yaw; the vertical axis needs none.
  int steps() const { return steps_; }
  int step_of(double yaw_rad) const;
  double yaw_rad(int step) const { return base_yaw_rad_ + 2.0 * kPi * step / steps_; }
  bool is_vertical(std::size_t axis) const { return axes_[axis].members == 1; }

  // The axis in the frame of a tree with this yaw step. Equal keys mean equal directions.
  std::size_t keys() const { return keys_; }
  std::size_t key(std::size_t axis, int step) const;
  Vec3 local(std::size_t axis, int step) const;

 private:
  struct Axis {
    double cos_zenith;
    int members;  // of its ring
    int index;    // in its ring
    double offset_turns;
    std::size_t first_key;
  };
  void add_ring(double cos_zenith, int members, double offset_turns);

  double base_yaw_rad_;
  int steps_;
  std::size_t keys_ = 0;
  std::vector<Axis> axes_;
  std::vector<Vec3> upward_;
};

}  // namespace sunfleck
