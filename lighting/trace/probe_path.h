// One path of light followed backwards from a face, all bands at once.
#pragma once

#include <span>
#include <vector>

#include "lighting/optics/optics.h"
#include "lighting/sky/illumination.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/random.h"

namespace sunfleck::trace {

// What a path brings to the face it starts from, W m-2, per band.
struct PathLight {
  std::vector<double> sky_w_m2, scattered_w_m2;
  explicit PathLight(std::size_t bands) : sky_w_m2(bands), scattered_w_m2(bands) {}
  void clear();
  void scale(double factor);
};

// What the side of a surface that a path met gives back, per band: of the light on that side, and of the
// light on the other.
struct MetSurface {
  std::vector<double> reflect, pass;
  bool is_shoot = false;
};

// Told of everything that has a say in what a path brings, in the order of the path. `weight`: of what the
// path may still bring, per band, E / (pi * radiance).
class PathWatch {
 public:
  virtual ~PathWatch() = default;
  virtual void met(const RayHit& hit, const Vec3& direction, const std::vector<double>& weight) = 0;
  // Sunlight of `lost_w_m2` per band that the path would bring from where it is, had it not been for `by`.
  virtual void shaded(const RayHit& by, const std::vector<double>& lost_w_m2) = 0;
};

class PathTracer {
 public:
  // All must outlive the tracer; `light` as returned by checked(). One tracer per thread.
  PathTracer(const Forest& forest, const RayScene& rays, const OpticsTable& optics,
             const Illumination& light);

  // From a point of a face into a cosine-distributed direction; adds what the path brings.
  void follow(Vec3 origin_m, Vec3 direction, RayStart from, RandomStream& random, PathLight& light);
  // From now on; changes no path. Must outlive the paths that it watches; null: nobody.
  void watch(PathWatch* watch) { watch_ = watch; }

 private:
  void add_sky(const Vec3& direction, std::vector<double>& to) const;
  void look_up(const RayHit& hit);
  void look_up_foliage(const RayHit& hit);
  void add_sun(const RayHit& hit, RandomStream& random, std::vector<double>& to);
  bool sun_is_hidden(const RayHit& hit, const Vec3& to_sun, const RayStart& from) const;
  bool survives(RandomStream& random);
  bool chooses_reflection(RandomStream& random);
  void leave(const RayHit& hit, bool reflected, RandomStream& random, Vec3& direction, RayStart& from) const;

  const Forest& forest_;
  const RayScene& rays_;
  const OpticsTable& optics_;
  const Illumination& light_;
  const SkyRadiance sky_;
  const double sun_facing_;
  bool any_beam_;
  std::vector<double> weight_;    // of what is still to be found, per band
  std::vector<double> sunlight_;  // that the path gets from where it is, per band
  MetSurface met_;
  PathWatch* watch_ = nullptr;
};

// A beam of 1 on a plane that faces the middle of the sun's disc is 1: the disc's mean cosine to its own axis
// is (1 + cos half_angle) / 2.
double sun_facing_factor(const Illumination& light);
bool has_beam(const Illumination& light);

}  // namespace sunfleck::trace
