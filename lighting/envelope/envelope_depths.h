// What the envelope method keeps of a leaf: its optical depth towards the eight cube corners, and towards the
// sun. The published method sorts all other leaves into eight bins per leaf, which costs the square of their
// number and overestimates the shade of near leaves; here every depth is one march of the leaf-area grid.
#pragma once

#include <array>
#include <vector>

#include "lighting/depth/blocker_field.h"
#include "lighting/envelope/envelope_estimator.h"
#include "sim/base/run_control.h"

namespace sunfleck::envelope {

// Optical depths towards cube_directions(), each in [0, kLargestDepth], per element.
using SectorDepths = std::vector<std::array<float, 8>>;
struct MarchedSectors {
  SectorDepths depths;
  std::size_t clamped = 0;  // contributions cut off at 0.9 of a cell's face, all grids together
};
MarchedSectors march_sectors(const BlockerField& field, const RunControl& control);

// Optical depth towards the sun per element: interpolated (Eq. 7) or marched; kLargestDepth where the ground
// is in the way. `to_sun` is unit.
std::vector<float> sun_depths(const BlockerField& field, const SectorDepths& sectors, const Vec3& to_sun,
                              EnvelopeSun method, const RunControl& control);

}  // namespace sunfleck::envelope
