// Radiance towards the viewer, as red, green and blue of one band.
//
// Leaves: bi-Lambertian, from the stored irradiance of the element seen (constant over the element):
//   seen from the front  L = (r_f E_front + t_b E_back) / pi, from the back likewise, a shoot: mean of both.
// Wood and ground have no stored light. L = albedo / pi * (sun through one shadow ray + what kGatherRays
// cosine-distributed rays meet: the sky, leaves with their stored light, and wood or ground in open light).
// The last is the only guess: ground and wood met by a gather ray are taken as unshaded.
// Sky: its radiance, and the disc of the sun for who looks at it. A sun of no size has no disc.
#pragma once

#include "lighting/base/light_map.h"
#include "lighting/render/picture_colour.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/random.h"

namespace sunfleck {

inline constexpr int kGatherSide = 2;
inline constexpr int kGatherRays = kGatherSide * kGatherSide;

class Shader {
 public:
  // All must outlive it; sizes of map, forest and light match. Const and safe from many threads.
  Shader(const Forest& forest, const ForestIndex& index, const OpticsTable& optics, const LightMap& map,
         const Illumination& light, const RayScene& scene);

  // What comes along a camera ray that met `hit`.
  Vec3 radiance(const RayHit& hit, const Vec3& direction, RandomStream& random) const;
  std::size_t element_of(const RayHit& hit) const;

 private:
  Vec3 leaf(const RayHit& hit) const;
  Vec3 opaque(const RayHit& hit, double albedo, const Vec3& exponent, RandomStream& random) const;
  Vec3 gathered(const RayHit& hit, const Vec3& direction) const;  // what a gather ray brings
  Vec3 in_the_open(const RayHit& hit, double albedo, const Vec3& exponent) const;
  Vec3 sun_irradiance(const RayHit& hit, RandomStream& random) const;
  Vec3 sky(const Vec3& direction) const;
  Vec3 background(const Vec3& direction) const;
  double bark_albedo(const RayHit& hit) const;
  Vec3 channels(const FaceLight& light) const;

  const Forest& forest_;
  const ForestIndex& index_;
  const OpticsTable& optics_;
  const LightMap& map_;
  const Illumination& light_;
  const SkyRadiance sky_;
  const RayScene& scene_;
  std::size_t band_;
  PictureColour colour_;
};

}  // namespace sunfleck
