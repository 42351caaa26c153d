// What a ray met, as red, green and blue of the picture's band: the one place that turns optics, textures and
// patterns into numbers, for both render modes.
#pragma once

#include "lighting/optics/optics.h"
#include "lighting/render/picture_light.h"
#include "lighting/render/picture_scene.h"

namespace sunfleck {

// Radiance towards the ray's origin of light from direction w:
//   w on the side met:  reflect / pi  (of which share `gloss` in a lobe around the mirror direction)
//   w on the other:     pass / pi
//   a shoot:            (reflect + pass) / (4 pi) from everywhere, no cosine: needles point everywhere.
// A needle drawn for itself is a sheet at the place it is met: what passes leaves on the other side of it.
struct Surface {
  Vec3 reflect{0}, pass{0};
  Vec3 normal{0, 0, 1};  // unit, of the geometry, on the side met
  bool is_shoot = false;
  double gloss = 0;
  Vec3 gloss_normal{0, 0, 1};
  double gloss_exponent = 20;
};

// Scattered radiance towards `to_viewer` per incident radiance, solid angle and cosine_factor.
Vec3 scattering(const Surface& surface, const Vec3& from_light, const Vec3& to_viewer);

// |cosine| to the normal; 1 for a shoot.
double cosine_factor(const Surface& surface, const Vec3& direction);

class SurfaceTable {
 public:
  // All must outlive it.
  SurfaceTable(const PictureScene& scene, const OpticsTable& optics, std::size_t band,
               const PictureColour& colour, const PictureLook& look);
  // For hits on leaves, wood and the upper side of the ground.
  // `footprint_m`: width of what is seen as one there; finer patterns come as their mean.
  Surface at(const RayHit& hit, double footprint_m = 0.0) const;

 private:
  // Of a material in the channels, without patterns.
  struct Colours {
    Vec3 reflect_front, reflect_back, pass_front, pass_back, bark;
  };
  Surface leaf(const RayHit& hit, double footprint_m) const;
  Surface wood(const RayHit& hit, double footprint_m) const;
  Surface ground(const RayHit& hit, double footprint_m) const;

  const PictureScene& scene_;
  const PictureLook& look_;
  std::vector<std::vector<Colours>> colours_;  // per original prototype and material
  Vec3 soil_;
};

}  // namespace sunfleck
