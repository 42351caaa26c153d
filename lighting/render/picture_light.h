// Sun and sky in the channels of a picture, with draws for path tracing.
#pragma once

#include <vector>

#include "lighting/render/picture_colour.h"
#include "lighting/sky/illumination.h"

namespace sunfleck {

class PictureLight {
 public:
  // `light` as checked() returns it; it must outlive this.
  PictureLight(const Illumination& light, std::size_t band, const PictureColour& colour);

  bool has_beam() const { return has_beam_; }
  // Irradiance of a plane by the sun in direction `to_sun` of the disc, per cosine to it: sums to the beam
  // over the disc (its mean cosine to its own axis is (1 + cos half_angle) / 2).
  const Vec3& beam_w_m2() const { return beam_; }
  // A point of the sun's disc from two numbers in [0, 1), evenly in solid angle.
  Vec3 towards_sun(const Vec2& number) const;

  bool has_sky() const { return has_sky_; }
  // Radiance, W m-2 sr-1; 0 at and below the horizon.
  Vec3 sky(const Vec3& direction) const;
  // What a camera sees where nothing is: the sky, the sun's disc, and below the horizon the sky at it.
  Vec3 background(const Vec3& direction) const;
  // Irradiance of open level ground.
  Vec3 open_ground() const;

  // A direction of the upper hemisphere with density in proportion to the sky's radiance, constant on 2,048
  // cells of equal solid angle, and one part in twenty even.
  struct Draw {
    Vec3 direction;
    double density_per_sr;
  };
  Draw draw_sky(const Vec2& number) const;
  double sky_density_per_sr(const Vec3& direction) const;

 private:
  void tabulate();
  Vec3 relative_tint(const Vec3& direction) const;

  const Illumination& light_;
  SkyRadiance sky_;
  BandLight strength_;
  PictureColour colour_;
  Vec3 beam_{0}, diffuse_{0};
  Vec3 tint_scale_{1};  // brings the gradient's mean to 1, weighted as level ground sees it
  bool has_beam_ = false, has_sky_ = false;
  std::vector<double> up_to_, density_;  // per cell: running share, density per steradian
};

}  // namespace sunfleck
