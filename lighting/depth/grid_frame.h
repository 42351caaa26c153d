// The frame of leaf-area grids: the world moved to the middle of the scene, so that a scene at coordinates of
// 1e6 m loses nothing to rounding; in a periodic scene moved to the corner of the period and sheared along z
// by the slope of the ground, which makes copies that follow the ground exact repetitions and leaves rays
// straight.
#pragma once

#include <optional>

#include "sim/base/vec.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct GridFrame {
  Vec3 origin_m{0};
  Vec2 shear{0};  // metres of height per metre east and north
  Vec3 ground_normal{0, 0, 1};
  std::optional<Vec2> period_m;

  Vec3 field_from_world(const Vec3& point_m) const;      // into the base period
  Vec3 unwrapped_from_world(const Vec3& point_m) const;  // the same without going back into the period
  // Of a direction; keeps lengths of parameters: p + t w maps to field(p) + t field(w).
  Vec3 field_direction(const Vec3& direction) const;
  // True where a ray in `direction` ends on the ground plane sooner or later.
  bool ends_on_ground(const Vec3& direction) const;
  // Box of one period in x and y in this frame.
  std::optional<Box> period_box() const;
};

GridFrame grid_frame(const Forest& forest);

}  // namespace sunfleck
