// What each cell of the leaf-area grid holds, sorted by cell: parts of foliage elements and wood, with all
// that is needed to let them take in and give off light.
//
// Along a direction w light runs in tubes as wide as the columns of cells it steps through, h^2 / s across, s
// the step from slab to slab over the edge h of a cell. A part of projected area P blocks the share q = P s /
// h^2 of its tube and adds the depth -ln(1 - q) to the step: the depth whose exponential is right on average
// when parts are independent. g is that depth divided by s, in the Pade form of -ln(1 - q),
// 3 q (2 - q) / (6 - 6 q + q^2), 1e-5 close at q = 1/4, 9 % low at the largest q of 0.9.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lighting/depth/blocker_field.h"
#include "lighting/transport/direction_set.h"

namespace sunfleck::transport {

struct DirectionLanes;

// Half a set of directions padded to whole vector registers; values for the padding are 0.
inline constexpr std::size_t kLanes = 16;
using Lanes = std::array<float, kLanes>;

inline constexpr float kLargestPartCover = 0.9f;
inline float depth_of_cover(float q) { return 3.0f * q * (2.0f - q) / (6.0f + q * (q - 6.0f)); }

struct LeafPart {
  Vec3f normal{0, 0, 1};  // unit; of flat elements
  float cover = 0;        // area of the part over h^2, never 0
  float share = 1;        // of the element's area
  std::uint32_t element = 0;
  std::uint32_t shoot = 0;   // index into shoots + 1; 0: flat
  std::uint32_t optics = 0;  // class, see LeafClasses
};

// A shoot's part: cover towards every direction of the half set, and the share of light from inside that gets
// out.
struct ShootPart {
  Lanes cover{};
  float escape = 1;
};

// Null: flat.
inline const ShootPart* shoot_of(const LeafPart& part, const ShootPart* shoots) {
  return part.shoot > 0 ? &shoots[part.shoot - 1] : nullptr;
}

struct WoodCell {
  std::uint32_t cell = 0;
  Lanes depth{};  // sum of g over all wood in the cell
};

// Classes of elements with the same optics: one per material of a prototype.
struct LeafClasses {
  std::vector<std::size_t> first;  // of each prototype
  std::size_t count = 0;
};
LeafClasses leaf_classes(const Forest& forest);

// Ranges of cells with about the same work.
struct CellRange {
  std::uint32_t begin = 0, end = 0;            // cells
  std::uint32_t wood_begin = 0, wood_end = 0;  // entries of `wood`
};

struct CellContents {
  std::vector<std::uint32_t> first_part;  // per cell, and the end
  std::vector<LeafPart> parts;            // by cell, then by element
  std::vector<ShootPart> shoots;
  std::vector<WoodCell> wood;  // by cell
  std::vector<CellRange> ranges;
  std::vector<std::uint32_t> parts_of_element, first_part_of_element;
};

// Elements below the ground are left out: neither lit nor shading.
CellContents cell_contents(const Forest& forest, const ForestIndex& index, const BlockerField& field,
                           const DirectionSet& set, const DirectionLanes& lanes, const RunControl& control);

// Sum of g over all wood of a cell along a unit direction, per WoodCell, for a step of one cell.
std::vector<float> wood_depths(const CellContents& contents, const BlockerField& field,
                               const Vec3& direction);

// exp(-extinction times half the way from slab to slab) for every half direction and cell, [half][cell].
std::vector<float> half_step_transmittance(const CellContents& contents, const DirectionLanes& lanes,
                                           std::size_t half, const RunControl& control);

}  // namespace sunfleck::transport
