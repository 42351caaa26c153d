// Parallel light through a WorldCanopy: one ray per box column, followed from the top to the ground.
//
// A box of area A whose trees show k per m2 towards the light has the depth k A / (edge^2 facing) for light
// that crosses its layer; facing is the cosine to the vertical on level ground. Every layer acts at its
// middle. Rays keep to their line (no spreading from layer to layer); where they cross a layer is rounded to
// whole boxes, the rounding drawn per layer, so that each box of a layer is met by exactly one ray: what
// boxes take and what arrives at the ground is what came, to rounding.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/canopy/world_canopy.h"

namespace sunfleck {

struct SweptLight {
  std::vector<float> ground;                 // transmitted share per box column [ny][nx]
  std::vector<double> intercepted_m2;        // per tree, of facing light
  double incident_m2 = 0, to_ground_m2 = 0;  // of the rays that aim at the columns' ground
};

class WorldSweep {
 public:
  explicit WorldSweep(const WorldCanopy& canopy) : canopy_(canopy) {}

  // `shown_per_area`: k, per tree. `seed` draws the rounding. Takes 4 bytes per box, kept for the next call.
  SweptLight run(const Vec3& to_source, std::span<const float> shown_per_area, std::uint64_t seed,
                 const RunControl& control);

 private:
  void fill_depths(double facing, std::span<const float> shown_per_area, const RunControl& control);
  void pass_layer(std::uint32_t layer, std::int64_t shift_x, std::int64_t shift_y);
  void move_window(std::int64_t by_x, std::int64_t by_y);
  void attribute(double facing, std::span<const float> shown_per_area, SweptLight& out,
                 const RunControl& control) const;

  const WorldCanopy& canopy_;
  std::vector<float> boxes_;  // depth; after a layer is passed: light that arrives per depth taken
  // Share that is left of every ray: periodic, by the column it aims at; else of the rays over the boxes of
  // the layer (those that leave never come back, those that come in are fresh).
  std::vector<float> light_, moved_;
};

}  // namespace sunfleck
