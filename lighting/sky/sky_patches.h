// The hemisphere cut into patches of known solid angle: rings around the zenith, each cut into equal azimuths
// (the first one starts at north). A sky of any kind becomes one mean radiance per patch.
#pragma once

#include <cstddef>
#include <vector>

#include "lighting/sky/sky_radiance.h"
#include "sim/base/vec.h"

namespace sunfleck {

// One direction per patch. to_source.z is the patch's mean of cos(zenith), so that the sum of
// solid_angle_sr * to_source.z is pi, without error, and a horizontal plane gets each patch's light exactly.
// Solid angles sum to 2 pi.
struct SkyDirections {
  std::vector<Vec3> to_source;         // unit, z > 0
  std::vector<double> solid_angle_sr;  // > 0, one per direction

  std::size_t size() const { return to_source.size(); }
};

class HemisphereGrid {
 public:
  // Patches of equal solid angle, about patch_deg x patch_deg each (12: 141, 6: 578, 2.5: 3,306); patch_deg
  // in [1, 30].
  static HemisphereGrid equal_area(double patch_deg);
  // The 145 patches of Tregenza 1987 (Lighting Research and Technology 19:13-14): bands of 12 degrees of
  // 30, 30, 24, 24, 18, 12 and 6 patches from the horizon up, and a cap of 6 degrees around the zenith.
  static HemisphereGrid tregenza();

  std::size_t size() const { return directions_.size(); }
  const SkyDirections& directions() const { return directions_; }
  // The patch that holds a unit direction; those below the horizon count as at it.
  std::size_t patch_of(const Vec3& direction) const;

  // Points inside the patches, the same number in a row for each patch, all of a patch standing for equal
  // shares of its solid angle.
  struct Points {
    std::vector<Vec3> direction;
    std::vector<double> solid_angle_sr;
  };
  Points points(int along_zenith, int along_azimuth) const;

 private:
  struct Ring {
    double z_low, z_high;  // cos(zenith)
    std::size_t first_patch, patches;
  };
  explicit HemisphereGrid(const std::vector<double>& falling_z, const std::vector<int>& patches);

  std::vector<Ring> rings_;  // from the zenith down
  SkyDirections directions_;
};

// Mean radiance of each patch, 1/sr, for a diffuse irradiance of 1: scaled so that the sum of radiance *
// solid_angle_sr * to_source.z is 1 to rounding. `points` are the grid's own (sky_points below). The scaling
// changes radiances by under 0.4 % at 6 degrees and 0.8 % at 12 for a sun above 50 degrees of elevation,
// by 1.4 and 5 % for a clear sky with the sun at the horizon, which is brightest where a patch counts least.
std::vector<double> patch_radiance(const SkyRadiance& sky, const HemisphereGrid& grid,
                                   const HemisphereGrid::Points& points);
// The same without the detour of normalising the sky by itself: for thousands of skies.
std::vector<double> patch_radiance(const PerezSky& sky, const HemisphereGrid& grid,
                                   const HemisphereGrid::Points& points);
// Points about 3 degrees apart: the narrowest halo of the sun is 8 degrees wide.
HemisphereGrid::Points sky_points(const HemisphereGrid& grid);

}  // namespace sunfleck
