// Sun and sky of one moment, per band. Everything is linear in the strengths.
#pragma once

#include <string>
#include <vector>

#include "lighting/sky/sky_radiance.h"
#include "sim/base/vec.h"

namespace sunfleck {

// Strengths of one band.
struct BandLight {
  double beam_normal_w_m2 = 0;         // sunlight on a plane that faces the sun
  double diffuse_horizontal_w_m2 = 0;  // sky light on a horizontal plane, nothing in the way
};

struct Illumination {
  Vec3 to_sun{0, 0, 1};           // unit; below the horizon there is no sunlight
  double sun_half_angle_rad = 0;  // 0: a point; the real sun 0.265 degrees
  SkyModel sky = SkyModel::kUniform;
  std::vector<BandLight> bands;  // one per band of the OpticsTable
  // Of SkyModel::kPerez only (perez_sky.h): 1 overcast to above 6.2 clear; 0.05 dark to 0.6 bright. Of
  // measured radiation: perez_sky().
  double sky_clearness = 1;
  double sky_brightness = 0.2;

  bool sun_is_up() const { return to_sun.z > 0.0; }
};

// The sky of an illumination as a function of direction, for a diffuse irradiance of 1.
SkyRadiance sky_radiance(const Illumination& light);
// Equal for lights with the same sky, and only for those.
std::string sky_key(const Illumination& light);

// Throws Error(kInvalidInput) naming "illumination.<field>": to_sun not finite or of length 0 (else it is
// returned normalised), strengths negative or not finite, number of bands wrong, half angle outside [0, 5]
// degrees; with a Perez sky clearness below 1 or brightness outside [0, 1].
Illumination checked(Illumination light, std::size_t band_count);

}  // namespace sunfleck
