// See sector_set.h.
#include "lighting/envelope/sector_set.h"

#include <algorithm>
#include <cmath>

#include "lighting/sky/sky_by_direction.h"
#include "sim/base/contract.h"

namespace sunfleck::envelope {

namespace {

// Shares of the sphere of one direction of each kind (Lebedev 1976): faces, edges and corners of a cube, and
// directions like (1, 1, 3).
struct CubicShares {
  double face = 0, edge = 0, corner = 0, steep = 0;
};

CubicShares cubic_shares(int count) {
  switch (count) {
    case 8:
      return {.corner = 1.0 / 8};
    case 14:
      return {.face = 1.0 / 15, .corner = 3.0 / 40};
    case 26:
      return {.face = 1.0 / 21, .edge = 4.0 / 105, .corner = 9.0 / 280};
    default:
      return {.face = 4.0 / 315, .edge = 64.0 / 2835, .corner = 27.0 / 1280, .steep = 14641.0 / 725760};
  }
}

bool in_upper_half(const Vec3& w) { return w.z > 0 || (w.z == 0 && (w.y > 0 || (w.y == 0 && w.x > 0))); }

// Share of the direction (x, y, z), components in {0, 1, 3} but for their signs; 0 if it is of no kind.
double share_of(const CubicShares& shares, const Vec3& w) {
  const double squares = glm::dot(w, w);
  if (squares == 1) return shares.face;
  if (squares == 2) return shares.edge;
  if (squares == 3) return shares.corner;
  return squares == 11 ? shares.steep : 0.0;
}

void add(SectorSet& set, const Vec3& direction, double share) {
  set.to_source.push_back(glm::normalize(direction));
  set.solid_angle_sr.push_back(4.0 * kPi * share);
}

// Adds the opposites of the directions there are.
void complete(SectorSet& set) {
  const std::size_t half = set.count();
  for (std::size_t j = 0; j < half; ++j) {
    set.to_source.push_back(-set.to_source[j]);
    set.solid_angle_sr.push_back(set.solid_angle_sr[j]);
  }
}

// A ring of `count` directions at `cosine` from the pole that shares `weight` of the hemisphere.
void add_ring(SectorSet& set, const Vec3& pole, double cosine, double weight, int count) {
  const Basis basis = basis_around(pole);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  for (int i = 0; i < count; ++i) {
    const double turn = 2.0 * kPi * (i + 0.5) / count;
    add(set, sine * std::cos(turn) * basis.tangent + sine * std::sin(turn) * basis.bitangent + cosine * pole,
        0.5 * weight / count);
  }
}

}  // namespace

SectorSet cubic_sectors(int count) {
  SUNFLECK_EXPECTS(std::ranges::find(kSectorCounts, count) != std::end(kSectorCounts));
  const CubicShares shares = cubic_shares(count);
  SectorSet set;
  for (const int z : {-3, -1, 0, 1, 3})
    for (const int y : {-3, -1, 0, 1, 3})
      for (const int x : {-3, -1, 0, 1, 3}) {
        const Vec3 w(x, y, z);
        const double share = share_of(shares, w);
        if (share > 0.0 && in_upper_half(w)) add(set, w, share);
      }
  complete(set);
  SUNFLECK_ENSURES(set.count() == static_cast<std::size_t>(count));
  return set;
}

SectorSet layered_sectors(int count, const Vec3& pole) {
  SUNFLECK_EXPECTS(std::ranges::find(kSectorCounts, count) != std::end(kSectorCounts));
  SectorSet set;
  if (count == 8) {
    add_ring(set, pole, 0.5, 1.0, 4);
  } else if (count == 14) {
    const double node = std::sqrt(1.0 / 3);  // Gauss, two nodes
    add_ring(set, pole, 0.5 * (1 + node), 0.5, 4);
    add_ring(set, pole, 0.5 * (1 - node), 0.5, 4);
  } else if (count == 26) {
    const double root = std::sqrt(6.0);  // Radau, three nodes with the pole
    add(set, pole, 1.0 / 18);
    add_ring(set, pole, (4 + root) / 10, (16 + root) / 36, 4);
    add_ring(set, pole, (4 - root) / 10, (16 - root) / 36, 8);
  } else {  // Radau, four nodes with the pole
    add(set, pole, 1.0 / 32);
    add_ring(set, pole, 0.787659461760847, 0.328844319980060, 8);
    add_ring(set, pole, 0.409466864440735, 0.388193468843172, 8);
    add_ring(set, pole, 0.088587959512704, 0.220462211176768, 8);
  }
  complete(set);
  return set;
}

SectorSky sector_sky(const SectorSet& set, const SkyRadiance& sky, const Vec3& ground_normal) {
  SkyByDirection seen = sky_by_direction(set.to_source, sky, ground_normal);
  return {std::move(seen.radiance), std::move(seen.ground_share), seen.open_ground_irradiance};
}

}  // namespace sunfleck::envelope
