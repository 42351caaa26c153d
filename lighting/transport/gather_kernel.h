// Light on both faces of one part of an element from the radiance of the cells around it, in a plain form and
// in one for machines with AVX-512. The rule is in element_gather.h and leaf_scattering.h.
#pragma once

#include "lighting/transport/cell_contents.h"
#include "lighting/transport/lanes.h"
#include "lighting/transport/leaf_bands.h"

namespace sunfleck::transport {

// Radiance of a cell: from the directions of the half set, and from their opposites.
struct alignas(64) CellRadiance {
  alignas(64) Lanes near{}, far{};
};

// Cells whose middles are around a point, and their weights; the cell it is in among them.
struct Corners {
  std::array<std::size_t, 8> cell{};
  std::array<float, 8> weight{};
  std::size_t own_cell = 0;
  float own_weight = 0;
};

// A part in two kinds of light at once, or in one.
struct PartInLight {
  const LeafPart& part;
  const ShootPart* shoot;  // null: flat
  const Corners& corners;
  std::array<const CellRadiance*, 2> radiance{};  // of all cells; the second null where there is but one
  std::array<FacePair, 2> given{};                // radiosity of the part that is in `radiance`
};

using GatherPart = void (*)(const PartInLight& part, const DirectionLanes& lanes, FacePair* light);
void gather_part_plain(const PartInLight& part, const DirectionLanes& lanes, FacePair* light);
// The fastest form this machine runs. All agree but for rounding.
GatherPart gather_part_best();

}  // namespace sunfleck::transport
