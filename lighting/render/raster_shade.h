// From the number of a figure and a place of the picture to the light that comes from there.
#pragma once

#include "lighting/render/camera_rays.h"
#include "lighting/render/raster_gather.h"
#include "lighting/render/raster_trees.h"

namespace sunfleck {

class RasterShader {
 public:
  // All must outlive it. `frame` of the whole picture.
  RasterShader(const ShadingParts& parts, const Shader& shader, GatheredLight& gathered,
               const SeenTrees& trees, const CameraRays& rays, const RasterFrame& frame,
               const Illumination& light)
      : parts_(parts),
        shader_(shader),
        gathered_(gathered),
        trees_(trees),
        rays_(rays),
        frame_(frame),
        light_(light) {}

  // What a ray through the place meets if it meets that figure; where it misses it by rounding, the figure's
  // nearest point. Of a shoot its axis.
  RayHit hit_at(std::uint32_t number, const CameraRay& ray) const;
  // Radiance towards the camera without traced sunlight, and what the sun adds where it is seen.
  Shader::SunAndRest light_at(std::uint32_t number, const Vec2& place_px) const;
  Vec3 sky_at(const Vec2& place_px) const;
  // Whether a pixel there may show a part of the sun's disc.
  bool near_disc(const Vec2& place_px) const;

 private:
  RayHit ground_hit(const CameraRay& ray) const;
  RayHit flat_hit(const SeenTree& tree, const FlatFigure& figure, const CameraRay& ray) const;
  RayHit round_hit(const SeenTree& tree, const RoundFigure& figure, const CameraRay& ray) const;
  double pixel_m(const RayHit& hit, const Vec3& direction) const;

  const ShadingParts& parts_;
  const Shader& shader_;
  GatheredLight& gathered_;
  const SeenTrees& trees_;
  const CameraRays& rays_;
  const RasterFrame& frame_;
  const Illumination& light_;
};

}  // namespace sunfleck
