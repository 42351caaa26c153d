// Directions along which radiance is followed, with the solid angle each stands for.
#pragma once

#include <vector>

#include "sim/base/vec.h"

namespace sunfleck::transport {

// Unit vectors from the scene towards where light comes from; entry half + j is the opposite of entry j.
struct DirectionSet {
  std::vector<Vec3> to_source;
  std::vector<double> solid_angle_sr;  // of each; they sum to 4 pi

  std::size_t count() const { return to_source.size(); }
  std::size_t half() const { return to_source.size() / 2; }
};

// Corners, faces and edges of a cube with Lebedev's weights (exact for polynomials of degree 3, 5 and 7 over
// the sphere); in a grid of cubes every one runs from cell centre to cell centre. `count`: 8, 14, 26.
DirectionSet cubic_directions(int count);

// Rings around `pole` at Gauss or Radau nodes of each hemisphere, none of them level: exact fluxes through
// planes across the pole, the choice for endless layers. 8, 16 (for 14) or 26 directions.
DirectionSet layered_directions(int count, const Vec3& pole);

}  // namespace sunfleck::transport
