#include "lighting/trace/probe_sun.h"

#include <cmath>

#include "lighting/trace/probe_path.h"

namespace sunfleck::trace {
namespace {

double fraction_of(double x) { return x - std::floor(x); }

// Roberts' R2 sequence: steps of the plastic number's powers fill the square evenly for any count.
class Points {
 public:
  Points(SunPoints kind, RandomStream& random) : kind_(kind), random_(random) {
    if (kind == SunPoints::kSpread) a_ = random.uniform(), b_ = random.uniform();
  }
  SurfacePoint on(const SurfaceSampler& surface) {
    if (kind_ == SunPoints::kIndependent) return surface.sample(random_);
    a_ = fraction_of(a_ + 0.7548776662466927);
    b_ = fraction_of(b_ + 0.5698402909980532);
    return surface.sample_at(a_, b_, surface.is_shoot() ? random_.uniform() : 0.0);
  }

 private:
  SunPoints kind_;
  RandomStream& random_;
  double a_ = 0, b_ = 0;
};

}  // namespace

SunOnSurface sun_on_surface(const RayScene& scene, const SurfaceSampler& surface, const Illumination& light,
                            int rays, SunPoints kind, RandomStream& random) {
  const double facing = sun_facing_factor(light);
  Points points(kind, random);
  SunOnSurface sun;
  double squares = 0.0;
  for (int k = 0; k < rays; ++k) {
    const SurfacePoint at = points.on(surface);
    const Vec3 to_sun = cone_direction(light.to_sun, light.sun_half_angle_rad, random);
    const double cosine = glm::dot(at.normal, to_sun);
    if (scene.occluded(at.position_m, to_sun, 0.0, surface.start(at, cosine >= 0.0))) continue;
    sun.seen += 1.0;
    // Needles face everywhere alike: a quarter of the beam on each of their faces.
    const double front = surface.is_shoot() ? 0.25 : facing * std::max(0.0, cosine);
    const double back = surface.is_shoot() ? 0.25 : facing * std::max(0.0, -cosine);
    sun.front += front;
    sun.back += back;
    squares += (front + back) * (front + back);
  }
  sun.front /= rays;
  sun.back /= rays;
  sun.seen /= rays;
  const double mean = sun.front + sun.back;
  if (kind == SunPoints::kIndependent && rays >= 2)
    sun.variance = std::max(0.0, squares / rays - mean * mean) / (rays - 1.0);
  return sun;
}

}  // namespace sunfleck::trace
