// What a sensor sees of the canopy: openness, gaps by zenith angle, leaf area and clumping from the gaps, and
// the virtual hemispherical photograph. Rays from the sensor over the upper hemisphere, evenly in zenith
// angle and azimuth; stems and branches count as canopy ("plant area").
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lighting/canopy/sensor_light.h"

namespace sunfleck {

struct CanopyOptions {
  int zenith_steps = 60, azimuth_steps = 180;  // 9 .. 1800 and 24 .. 7200; rays per sensor: their product
  double last_zenith_deg = 90;                 // 10 .. 90: what lies lower is not looked at for openness
  std::uint64_t seed = 1;
};

// Gaps between two zenith angles.
struct GapRing {
  double from_deg = 0, to_deg = 0;
  double gap_fraction = 1, standard_error = 0;  // by solid angle
  // Mean of the logarithm over 24 azimuth segments (Lang and Xiang 1986, Agric. For. Meteorol. 37): exp of
  // it; a segment without gap counts as half a ray.
  double log_mean_gap = 1;
  double clumping() const;  // ln(gap_fraction) / ln(log_mean_gap); 1 without canopy
};

struct SensorCanopy {
  double openness = 1, openness_error = 0;                // share of the hemisphere's solid angle
  double sky_view_factor = 1, sky_view_factor_error = 0;  // the same weighted by the cosine to the zenith
  std::vector<GapRing> rings_10_deg;                      // nine
  std::array<GapRing, 5> rings_lai2000;                   // around 7, 23, 38, 53 and 68 degrees
  // Plant area per ground area that would have these gaps if it were random (Miller 1967, with the weights
  // sin dtheta of Welles and Norman 1991 for five rings, scaled to a sum of 1); 10-degree rings up to 80.
  double effective_lai_lai2000 = 0, effective_lai_10_deg = 0, effective_lai_error = 0;
  double clumped_lai = 0;  // from the log-averaged gaps of the five rings
  double clumping = 1;     // effective_lai_lai2000 / clumped_lai
};

// One per sensor. Zenith is the world's, whatever the sensor's normal.
std::vector<SensorCanopy> sensor_canopy(const StandScene& scene, const std::vector<LightSensor>& sensors,
                                        const CanopyOptions& options, const RunControl& control);

// Share of every pixel that is sky; 0 outside the circle. Equidistant: zenith angle grows evenly from the
// middle (0) to the rim (90 degrees). Looking up: north at the top, EAST ON THE LEFT. Row 0 is the top.
struct HemisphericalPhotograph {
  int pixels = 0;          // edge
  std::vector<float> sky;  // [row][column]
};
struct PhotographOptions {
  int pixels = 512, samples_per_pixel = 4;  // 8 .. 8192; 1 .. 1024
  std::uint64_t seed = 1;
};
HemisphericalPhotograph hemispherical_photograph(const StandScene& scene, const LightSensor& sensor,
                                                 const PhotographOptions& options, const RunControl& control);

}  // namespace sunfleck
