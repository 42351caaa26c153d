// How the rays of a surface are dealt out. Sky light comes from above the horizon only, and it is what makes
// links noisy (a ray sees the sky or does not). So every face of a leaf has two lobes, above and below the
// horizon, each with its own rays: a face of normal n sees above the horizon the share (1 + n_z) / 2 of its
// cosine-weighted hemisphere, known exactly. And above it twice as many rays are cast as links are kept: the
// others only tell which share of the lobe is sky. Weights of a face add up to 1, so that even light stays
// even. Wood, whose normals turn, and ground have one lobe for all directions.
#pragma once

#include <array>
#include <cstddef>

#include "sim/base/vec.h"

namespace sunfleck::links {

enum Lobe : std::size_t { kFrontUp, kFrontDown, kBackUp, kBackDown, kLobes };

struct LobeShare {
  int links = 0;      // rays whose ends are kept
  int cast = 0;       // these and those that only tell sky from the rest
  double weight = 0;  // of all its rays together in the irradiance of its face
};
using Lobes = std::array<LobeShare, kLobes>;

// Of a flat leaf whose front normal has this z; of a shoot: 0.
Lobes leaf_lobes(int links_per_face, double normal_z);
// All directions of each face in its first lobe.
Lobes whole_lobes(int links_per_face);

enum class Part { kUp, kDown, kWhole };

// The direction with density proportional to the cosine to `normal` (unit) over that part of its hemisphere
// above, below or on both sides of the horizon, for a point (a, b) of the unit square.
Vec3 cosine_direction(const Vec3& normal, Part part, double a, double b);
// The same with even density over that part of the sphere.
Vec3 even_direction(Part part, double a, double b);

}  // namespace sunfleck::links
