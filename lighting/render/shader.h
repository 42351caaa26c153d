// Radiance towards the viewer from a light map, as red, green and blue of one band, without bounces.
//
// Leaves: bi-Lambertian, from the stored irradiance of the element seen:
//   seen from the front  L = (r_f E_front + t_b E_back) / pi, from the back likewise, a shoot: mean of both.
// Sky and scattered light are constant over the element; sunlight is that too (LeafSun::kStored) or asked by
// one shadow ray from the place seen (kTraced) or read from a tile (kTile, leaf_flecks.h). Scattered light
// has the colour of MeanLight. Wood and ground have no stored light. L = albedo / pi * (sun through one
// shadow ray + what one cosine-distributed ray meets: the sky, leaves with their stored light, and wood or
// ground in the mean light of all wood and ground, mean_light.h; ground beyond the forest's box in the open).
// Sky: its radiance, and the disc of the sun for who looks at it. A sun of no size has no disc.
#pragma once

#include "lighting/base/light_map.h"
#include "lighting/render/mean_light.h"
#include "lighting/render/path_samples.h"
#include "lighting/render/render.h"
#include "lighting/render/surface.h"

namespace sunfleck {

class LeafFlecks;

// What shading needs to know. All must outlive the shader; sizes of map and forest match.
struct ShadingParts {
  const PictureScene& scene;
  const ForestIndex& index;
  const BandLightMap& map;
  const SurfaceTable& surfaces;
  const PictureLight& light;
  PictureColour colour;
  LeafSun leaf_sun = LeafSun::kTraced;
  const LeafFlecks* flecks = nullptr;  // for kTile under a sun
};

// Const and safe from many threads.
class Shader {
 public:
  Shader(const ShadingParts& parts, const MeanLight& mean) : parts_(parts), mean_(mean) {}

  // What comes along a camera ray that met `hit`.
  Vec3 radiance(const RayHit& hit, const Vec3& direction, PathSamples& numbers) const;
  // What a gather ray that met `hit` brings: no ray is cast for it.
  Vec3 gathered(const RayHit& hit, const Vec3& direction) const;
  // Irradiance of the side of wood or ground that was met.
  Vec3 irradiance(const RayHit& hit, PathSamples& numbers) const;
  std::size_t element_of(const RayHit& hit) const;

 private:
  Vec3 leaf_seen(const RayHit& hit, const Vec3& to_viewer, PathSamples& numbers) const;
  Vec3 leaf_stored(const RayHit& hit) const;
  template <class Light>
  Vec3 leaf_lit(const RayHit& hit, const Light& light) const;
  Vec3 sun_scattered(const RayHit& hit, const Surface& surface, const Vec3& to_viewer,
                     const Vec2& number) const;
  Vec3 sun_flecked(const RayHit& hit, const Surface& surface, const Vec3& to_viewer,
                   const Vec2& number) const;
  Vec3 diffuse(const FaceLight& light) const;
  Vec3 total(const FaceLight& light) const;
  const ElementLight& light_of(const RayHit& hit) const;

  ShadingParts parts_;
  MeanLight mean_;
};

}  // namespace sunfleck
