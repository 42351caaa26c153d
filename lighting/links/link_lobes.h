// How the rays of a surface are dealt out. Sky light comes from above the horizon only, and it is what makes
// links noisy (a ray sees the sky or does not). So every face of a leaf has two lobes, above and below the
// horizon: a face of normal n sees above the horizon the share (1 + n_z) / 2 of its cosine-weighted
// hemisphere, known exactly. Above it more rays are cast than links are kept: the others only tell which
// share of the lobe is sky. Weights of a face add up to 1, so that even light stays even. Wood, whose normals
// turn, and ground have one lobe for all directions.
//
// The lobes of the two faces above the horizon together see every direction of the upper half sphere w in
// proportion to |n w|, and likewise below: one set of points is spread over both, so that what the leaf
// gets from either half of the world is as even as the points are.
#pragma once

#include <cstddef>

#include "sim/base/vec.h"

namespace sunfleck::links {

enum Lobe : std::size_t { kFrontUp, kFrontDown, kBackUp, kBackDown, kLobes };
enum class Half { kUp, kDown };

inline Lobe lobe_of(Half half, bool front) {
  if (half == Half::kUp) return front ? kFrontUp : kBackUp;
  return front ? kFrontDown : kBackDown;
}
// The other one of the same face, and the same half seen by the other face.
inline Lobe other_half(Lobe lobe) { return static_cast<Lobe>(lobe ^ 1u); }
inline Lobe other_face(Lobe lobe) { return static_cast<Lobe>(lobe ^ 2u); }

// Of one half, both faces together, with so many links per face: rays whose ends are kept, and all. A shoot's
// needles are met by lot, which takes more rays.
struct HalfCounts {
  int links = 0, cast = 0;
};
HalfCounts counts_of(Half half, bool is_shoot, int links_per_face);

// Share of a lobe in the irradiance of its face, for a leaf whose front normal has this z; of a shoot: 0.
// Lobes thinner than 1e-6 leave their share to the other one of the face.
double lobe_weight(Lobe lobe, double normal_z);

// For a point (a, b) of the unit square: a direction of that half sphere with density proportional to
// |n w|, and the face of the leaf of front normal n (unit) that looks there.
struct LeafDirection {
  Vec3 direction;
  bool front;
};
LeafDirection leaf_direction(const Vec3& normal, Half half, double a, double b);
// The direction with density proportional to the cosine to `normal` (unit) over that half of its hemisphere.
Vec3 lobe_direction(const Vec3& normal, Half half, double a, double b);
// Even over the half sphere.
Vec3 even_direction(Half half, double a, double b);

}  // namespace sunfleck::links
