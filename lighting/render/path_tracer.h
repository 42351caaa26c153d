// Path tracing of pictures: radiance along a ray with every bounce off leaves, wood and ground, unbiased.
//
// At every surface met, the sun is asked through a point of its disc and the sky through a draw in proportion
// to its radiance; the path then goes on into a cosine-distributed direction on the side chosen by its
// brightness. The sky is thus found in two ways, which are weighed by the balance heuristic (Veach and Guibas
// 1995). Paths whose weight falls below one half play Russian roulette.
//
// Light in the channels: a leaf's red, green and blue albedo act at every bounce, so light that leaves
// scattered is greener (the light map's is white).
#pragma once

#include "lighting/render/path_samples.h"
#include "lighting/render/surface.h"

namespace sunfleck {

class PathTracer {
 public:
  // All must outlive it. Const and safe from many threads.
  PathTracer(const PictureScene& scene, const SurfaceTable& surfaces, const PictureLight& light);

  // What arrives at `origin_m` from `direction` (unit: away from the viewer), W m-2 sr-1. The path stays
  // among the trees of one of the scene's casts.
  Vec3 radiance(Vec3 origin_m, Vec3 direction, PathSamples& samples, std::uint8_t cast = 0) const;

 private:
  struct Path;
  Vec3 given(const RayHit& hit, const Surface& surface, const Path& path, const Vec3& to_light) const;
  Vec3 sun(const RayHit& hit, const Surface& surface, const Path& path, const Vec2& number) const;
  Vec3 sky(const RayHit& hit, const Surface& surface, const Path& path, const Vec2& number) const;
  Vec3 sky_met(const Path& path) const;
  bool go_on(const RayHit& hit, const Surface& surface, const std::array<double, 4>& numbers,
             Path& path) const;

  const PictureScene& scene_;
  const SurfaceTable& surfaces_;
  const PictureLight& light_;
};

}  // namespace sunfleck
