// Parallel light through a BoxCanopy: one ray per box column, followed from the top to the ground.
//
// A box of area A whose trees show k per m2 towards the light has the depth k A / (edge^2 facing) for light
// that crosses its layer; facing is the cosine to the vertical on level ground. A layer acts at its
// middle, or, for light so low that it crosses more than one column on its way through, in as many parts.
// Rays keep to their line (no spreading from layer to layer); where they cross is rounded to whole boxes, the
// rounding drawn anew each time, so that each box is met by exactly one ray at a time: what boxes take and
// what arrives at the ground is what came, to rounding.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/canopy/box_canopy.h"

namespace sunfleck {

struct SweptLight {
  std::vector<float> ground;                 // transmitted share per box column [ny][nx]
  std::vector<double> intercepted_m2;        // per tree, of facing light
  double incident_m2 = 0, to_ground_m2 = 0;  // of the rays that aim at the columns' ground
};

class BoxSweep {
 public:
  explicit BoxSweep(const BoxCanopy& canopy) : canopy_(canopy) {}

  // `shown_per_area`: k, per tree. `seed` draws the rounding. Takes 4 bytes per box, kept for the next call.
  SweptLight run(const Vec3& to_source, std::span<const float> shown_per_area, std::uint64_t seed,
                 const RunControl& control);

 private:
  void fill_depths(double facing, std::span<const float> shown_per_area, const RunControl& control);
  struct Shift {
    std::int64_t x = 0, y = 0;
  };
  int parts_of_a_layer(const Vec3& to_source, double facing) const;
  void pass_layer(std::uint32_t layer, float part, const Shift& shift);
  void move_window(std::int64_t by_x, std::int64_t by_y);
  void attribute(double facing, std::span<const float> shown_per_area, SweptLight& out,
                 const RunControl& control) const;

  const BoxCanopy& canopy_;
  std::vector<float> boxes_;  // depth; after a layer is passed: light taken per depth
  std::vector<float> taken_;  // of the layer being passed
  // Share that is left of every ray: periodic, by the column it aims at; else of the rays over the boxes of
  // the layer (those that leave never come back, those that come in are fresh).
  std::vector<float> light_, moved_;
};

}  // namespace sunfleck
