// A tree alone in parallel light: how much of it the tree takes, leaves and wood.
#pragma once

#include <cstdint>

#include "lighting/trace/ray_scene.h"
#include "sim/base/random.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// One prototype standing once at the origin, scale 1, on nothing.
class CrownAlone {
 public:
  CrownAlone(const Forest& forest, std::size_t prototype, const RunControl& control);
  CrownAlone(const CrownAlone&) = delete;
  CrownAlone& operator=(const CrownAlone&) = delete;

  const Forest& forest() const { return forest_; }

  struct Interception {
    double m2 = 0;          // of a plane that faces the light
    double quantum_m2 = 0;  // what one ray stands for
  };
  // `rays` >= 1, spread over the rectangle across the light that holds the crown; light comes evenly from a
  // cone round `to_source` (unit, in tree coordinates).
  Interception intercept(const Vec3& to_source, double half_angle_rad, int rays, RandomStream& random) const;

 private:
  const Forest forest_;
  const Box box_;
  const RayScene rays_;
};

}  // namespace sunfleck
