// Radiance towards the viewer from a light map, as red, green and blue of one band, without bounces.
//
// Leaves: bi-Lambertian, from the stored irradiance of the element seen:
//   seen from the front  L = (r_f E_front + t_b E_back) / pi, from the back likewise, a shoot: mean of both.
// Sky and scattered light are constant over the element; sunlight is that too (LeafSun::kStored) or asked by
// one shadow ray from the place seen (kTraced) or read from a tile (kTile, leaf_flecks.h). Scattered light
// has the colour of MeanLight.
// Wood and ground have no stored light. L = albedo / pi * (sun through one shadow ray + what one
// cosine-distributed ray meets within gather_reach_m (beyond: sky or ground): the sky, leaves with their
// stored light, and wood or ground in the mean light of all wood and ground, mean_light.h; ground beyond the
// forest's box in the open). Sky: its radiance, and the disc of the sun for who looks at it. A sun of no size
// has no disc.
#pragma once

#include <limits>

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
  double gather_reach_m = std::numeric_limits<double>::infinity();  // seen_trees.h
  const LeafFlecks* flecks = nullptr;                               // for kTile under a sun
};

// Const and safe from many threads.
class Shader {
 public:
  Shader(const ShadingParts& parts, const MeanLight& mean) : parts_(parts), mean_(mean) {}

  // What comes along a camera ray that met `hit`.
  Vec3 radiance(const RayHit& hit, const Vec3& direction, PathSamples& numbers) const;
  // What a gather ray from `origin_m` that met `hit` brings: no ray is cast for it.
  Vec3 gathered(const RayHit& hit, const Vec3& origin_m, const Vec3& direction) const;
  // Irradiance of the side of wood or ground that was met.
  Vec3 irradiance(const RayHit& hit, PathSamples& numbers) const;
  std::size_t element_of(const RayHit& hit) const;

  // Radiance towards the viewer in two parts: without traced sunlight, and what the sun adds where nothing
  // lies between (taken from the middle of its disc). A shoot's is the mean over its two faces. With stored
  // sunlight the second part is 0. `footprint_m` as for SurfaceTable::at.
  struct SunAndRest {
    Vec3 rest{0}, sun{0};
  };
  SunAndRest leaf_parts(const RayHit& hit, const Vec3& to_viewer, double footprint_m) const;
  // Irradiance of a plane with this normal by the middle of the sun's disc; 0 from behind.
  Vec3 open_sun(const Vec3& normal) const;
  // Sky and scattered light of a face.
  Vec3 diffuse(const FaceLight& light) const;
  const ElementLight& light_of(const RayHit& hit) const;

 private:
  Vec3 leaf_seen(const RayHit& hit, const Vec3& to_viewer, PathSamples& numbers) const;
  Vec3 leaf_stored(const RayHit& hit) const;
  Vec3 leaf_sunlit_as_stored(const RayHit& hit, const Surface& s, const Vec3& to_viewer) const;
  template <class Light>
  Vec3 leaf_lit(const RayHit& hit, const Surface& s, const Light& light) const;
  Vec3 sun_scattered(const RayHit& hit, const Surface& surface, const Vec3& to_viewer,
                     const Vec2& number) const;
  Vec3 beyond_reach(const Vec3& origin_m, const Vec3& direction) const;
  Vec3 off_ground(const RayHit& hit) const;
  Vec3 sun_flecked(const RayHit& hit, const Surface& surface, const Vec3& to_viewer,
                   const Vec2& number) const;
  Vec3 total(const FaceLight& light) const;

  ShadingParts parts_;
  MeanLight mean_;
};

}  // namespace sunfleck
