// The sky as a function of direction, whatever its model: what every estimator that integrates a sky asks.
#pragma once

#include <optional>

#include "lighting/sky/perez_sky.h"
#include "lighting/sky/sky_model.h"
#include "sim/base/vec.h"

namespace sunfleck {

// Radiance for a diffuse irradiance of 1 on a horizontal plane. Cheap to copy; read-only once made.
class SkyRadiance {
 public:
  SkyRadiance() = default;                    // uniform
  SkyRadiance(SkyModel model);                // a model that knows zenith angles only
  explicit SkyRadiance(const PerezSky& sky);  // normalised by a sum over 8,000 directions, to 0.03 %

  SkyModel model() const { return model_; }
  // True if the radiance depends on the zenith angle alone.
  bool is_round() const { return model_ != SkyModel::kPerez; }
  // Radiance from a unit direction, 1/sr; 0 at and below the horizon.
  double radiance(const Vec3& to_sky) const;
  // Mean over all azimuths at a zenith angle, 1/sr: what methods that see zenith angles only can use.
  double ring_mean(double cos_zenith) const;

 private:
  SkyModel model_ = SkyModel::kUniform;
  PerezShape shape_{0, -1, 0, -1, 0};
  Vec3 to_sun_{0, 0, 1};  // lifted to the horizon
  double scale_ = 1;
};

}  // namespace sunfleck
