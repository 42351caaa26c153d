// What the leaves of one cell make of the light in it: the innermost step of the grid's bounces, in a plain
// form and in one for machines with AVX-512. The rule is in leaf_scattering.h.
#pragma once

#include "lighting/transport/cell_contents.h"
#include "lighting/transport/lanes.h"
#include "lighting/transport/leaf_bands.h"

namespace sunfleck::transport {

// Radiance and sources of one cell: `near` from the directions of the half set, `far` from their opposites.
struct CellLight {
  alignas(64) Lanes near{}, far{}, source_near{}, source_far{}, depth{};
};

// One order of bounces, of all parts.
struct LeafOrder {
  const LeafPart* parts = nullptr;
  const ShootPart* shoots = nullptr;
  const LeafBand* bands = nullptr;
  const FacePair* direct = nullptr;  // by element; null: none
  float beam_w_m2 = 0;               // strength of `direct`
  float scale = 1;                   // of the radiance
  FacePair *last = nullptr, *total = nullptr;
};

// Parts `begin` to `end` of a cell take light from it, and add what they give back to its sources and their
// depth to it; `last` and `total` are brought up to date. Returns the power given back over h^2.
using ScatterLeaves = double (*)(const LeafOrder& order, const DirectionLanes& lanes, std::uint32_t begin,
                                 std::uint32_t end, CellLight& cell);

double scatter_leaves_plain(const LeafOrder& order, const DirectionLanes& lanes, std::uint32_t begin,
                            std::uint32_t end, CellLight& cell);

// The fastest form this machine runs. All agree but for rounding.
ScatterLeaves scatter_leaves_best();

// Adds to the cell what parts `begin` to `end` give back, and their depth; `given` is their radiosity, by
// part.
using EmitLeaves = void (*)(const LeafOrder& order, const DirectionLanes& lanes, const FacePair* given,
                            std::uint32_t begin, std::uint32_t end, CellLight& cell);
void emit_leaves_plain(const LeafOrder& order, const DirectionLanes& lanes, const FacePair* given,
                       std::uint32_t begin, std::uint32_t end, CellLight& cell);
EmitLeaves emit_leaves_best();

// Adds the sources of a part of these lanes and radiosity.
void deposit(CellLight& cell, const Lanes& cosine, const Lanes& depth, const FacePair& radiosity);

// Cosines and depths g of any part. `shoot`: null for a flat one.
inline void part_depths(const LeafPart& part, const ShootPart* shoot, const DirectionLanes& lanes,
                        Lanes& cosine, Lanes& depth) {
  if (shoot != nullptr) return shoot_depths(*shoot, lanes, cosine, depth);
  cosines_of(part, lanes, cosine);
  depths_of(part.cover, lanes, cosine, depth);
}

}  // namespace sunfleck::transport
