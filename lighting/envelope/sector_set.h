// The directions in which a leaf knows how much stands in its way, the solid angle each stands for, and what
// comes from outside along them.
//
// [Boulanger08] uses the eight corners of a cube (Eq. 26), each for an octant. More directions follow the
// crown better: corners, faces and edges of a cube with Lebedev's weights. Where a scene repeats for ever,
// level directions end nowhere; rings around the pole at Gauss or Radau heights take their place.
#pragma once

#include <vector>

#include "lighting/sky/illumination.h"
#include "sim/base/vec.h"

namespace sunfleck::envelope {

// Unit vectors from a leaf towards where light comes from; entry half + j is the opposite of entry j.
struct SectorSet {
  std::vector<Vec3> to_source;
  std::vector<double> solid_angle_sr;  // they sum to 4 pi

  std::size_t count() const { return to_source.size(); }
  std::size_t half() const { return to_source.size() / 2; }
  std::size_t opposite(std::size_t j) const { return (j + half()) % count(); }
};

inline constexpr int kSectorCounts[] = {8, 14, 26, 50};
inline constexpr std::size_t kMostSectors = 64;  // room for every set, in whole vector registers

// `count` is one of kSectorCounts. Exact for polynomials over the sphere of degree 3, 5, 7 and 11.
SectorSet cubic_sectors(int count);
// None level; exact fluxes through planes across `pole` (unit). 16 directions for a `count` of 14.
SectorSet layered_sectors(int count, const Vec3& pole);

// For a diffuse irradiance of 1 on a horizontal plane.
struct SectorSky {
  std::vector<double> sky_radiance;  // 1/sr, mean over the part of the sphere nearest to the direction,
                                     // counting 0 where that part is ground
  std::vector<double> ground_share;  // of that part, [0, 1]
  double open_ground_irradiance = 1;
};
SectorSky sector_sky(const SectorSet& set, const SkyRadiance& sky, const Vec3& ground_normal);

}  // namespace sunfleck::envelope
