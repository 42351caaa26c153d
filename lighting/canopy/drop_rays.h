// Rays of light that fall on a stand from one direction, spread evenly over the ground they aim at: the map,
// and beyond it, in a forest that does not repeat, as far as shadows of its trees that matter reach.
//
// Every ray stands for the same ground area and so for the same energy: quantum_m2 is the area of a facing
// plane whose light one ray carries. Rays that can meet nothing are counted but not traced.
#pragma once

#include <cstdint>

#include "lighting/canopy/stand_scene.h"
#include "sim/base/random.h"

namespace sunfleck {

struct DropRay {
  Vec3 origin_m{0};     // above everything
  Vec3 direction{0};    // downwards, unit
  Vec3 aim_m{0};        // where it would meet the ground
  bool may_hit = true;  // passes the box round the forest
  // Meets the ground where neither the map nor the forest is near, or passes surroundings only.
  bool is_far = false;
};

class DropRays {
 public:
  // `rays_on_map` > 0 of them aim at the map. `to_source` is unit; with StandGround::facing() of 0 there are
  // no rays. `half_angle_rad`: of the cone that light comes from.
  DropRays(const StandScene& scene, const Vec3& to_source, double half_angle_rad, double rays_on_map);

  std::size_t count() const { return columns_ * rows_; }  // about as many as asked for
  double quantum_m2() const { return quantum_m2_; }
  const Vec3& to_source() const { return to_source_; }
  // Ray number i; `random` is the ray's own stream.
  DropRay ray(std::size_t i, RandomStream& random) const;

 private:
  void cover(const StandScene& scene);
  Vec3 from_cone(RandomStream& random) const;
  bool is_near(const Vec3& aim_m) const;

  const StandScene& scene_;
  Vec3 to_source_;
  double half_angle_rad_;
  Vec2 lo_m_{0}, size_m_{0};            // of the ground aimed at
  std::size_t columns_ = 0, rows_ = 0;  // one ray in each of so many rectangles
  double quantum_m2_ = 0, most_facing_ = 1;
};

}  // namespace sunfleck
