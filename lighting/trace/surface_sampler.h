// Random points, evenly over the area of one receiving surface in world coordinates, with their normals.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/trace/directions.h"
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
  // The same from numbers in [0, 1) that spread over the surface as they spread over the unit square; of a
  // shoot over its length, and by (b, c) over its cross-section, without a normal: needles are turned any
  // way.
  SurfacePoint sample_at(double a, double b, double c) const;
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

}  // namespace sunfleck::trace
