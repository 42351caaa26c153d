// Random points, evenly over the area of one receiving surface in world coordinates, with their normals.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/trace/receivers.h"
#include "lighting/trace/solids.h"
#include "sim/base/random.h"

namespace sunfleck::trace {

struct SurfacePoint {
  Vec3 position_m, normal;  // normal of the front or outer face
  std::uint32_t local;      // the object it lies on: of a group of wood segments, which
};

class SurfaceSampler {
 public:
  SurfaceSampler(const Receivers& receivers, std::size_t surface);

  // For a shoot: a point of its volume and a needle normal turned any way.
  SurfacePoint sample(RandomStream& random) const;
  // The same from two numbers in [0, 1) that spread over the surface as they spread over the unit square;
  // only a shoot takes its remaining ones from `random`.
  SurfacePoint sample_at(double a, double b, RandomStream& random) const;
  const RayStart& object() const { return object_; }
  // What a ray from a sampled point starts on.
  RayStart start(const SurfacePoint& point, bool front) const;
  bool is_shoot() const { return shape_ == Shape::kShoot; }

 private:
  enum class Shape { kParallelogram, kDisc, kTriangle, kShoot, kCone };
  void take_element(const WorldElement& element);
  void take_wood(const Receivers& receivers);
  void take_ground(const Receivers& receivers);
  SurfacePoint sample_wood(double part, double turn) const;

  RayStart object_;
  Shape shape_ = Shape::kParallelogram;
  Vec3 origin_{0}, u_{0}, v_{0}, w_{0}, normal_{0, 0, 1};
  std::vector<ConeFrustum> cones_;     // of a group of wood segments
  std::vector<double> area_up_to_m2_;  // of the first, the first two, ... of them
};

// A direction with density cos / pi around the unit vector `normal`.
Vec3 cosine_direction(const Vec3& normal, RandomStream& random);
Vec3 cosine_direction(const Vec3& normal, double x, double y);  // from two numbers in [0, 1)
// A direction evenly within `half_angle` of the unit vector `axis`.
Vec3 cone_direction(const Vec3& axis, double half_angle_rad, RandomStream& random);
Vec3 cone_direction(const Vec3& axis, double half_angle_rad, double x, double y);
// A direction with even density over the sphere.
Vec3 any_direction(RandomStream& random);

}  // namespace sunfleck::trace
