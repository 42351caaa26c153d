// Everything of a forest that takes light away, flattened for leaf-area grids: foliage elements and wood as
// small projected areas, each with the grid cells it lies in. Made once per scene, used for any direction.
//
// Frame: see grid_frame.h.
//
// Projected areas, towards a unit vector w:
//   flat element     A |n.w|
//   shoot            S (1 - exp(-A / (2 S))), S the silhouette of its cylinder: needles turned evenly,
//   filling
//                    the cylinder, that shade each other; A/2 for a thin shoot
//   wood segment     (r_from + r_to) |axis x w|, opaque, without end caps
//   wood triangle    A |n.w| / 2: meshes are closed surfaces that a ray enters and leaves
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/depth/grid_frame.h"
#include "lighting/depth/grid_layout.h"
#include "sim/base/run_control.h"
#include "sim/base/vec.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// A foliage element. `axis`: unit front normal of a flat element, half the axis (metres) of a shoot; both are
// world directions.
struct FieldElement {
  Vec3f centre_m{0};  // in the field's frame, inside the base period
  Vec3f axis{0, 0, 1};
  float area_m2 = 0;
  float shoot_radius_m = 0;  // 0: flat
  std::uint32_t cell = 0;    // of the centre
  bool below_ground = false;

  bool is_shoot() const { return shoot_radius_m > 0.0f; }
};

double projected_area_m2(const FieldElement& element, const Vec3& direction);
// Share of the light from `direction` that the mean needle of a shoot gets past the other needles of its own
// shoot; 1 for a flat element.
double own_transmittance(const FieldElement& element, const Vec3& direction);

// Root of the area of a flat element, of the mean silhouette of a shoot.
double element_side_m(const FieldElement& element);

// A wood segment (width > 0; `vector` its axis) or triangle (width 0; `vector` half its area vector).
struct FieldWood {
  Vec3f vector{0};
  float width_m = 0;
};
double projected_area_m2(const FieldWood& wood, const Vec3& direction);

// A part of a blocker that is larger than a cell, or of wood: `share` of its area lies in `cell`.
struct BlockerPiece {
  std::uint32_t blocker = 0, cell = 0;
  float share = 1;
};

struct BlockerFieldOptions {
  double cell_m = 0;  // 0: leaf_cell_size()
  // Coarser cells instead of more than this, or than 512 per element where that is more than 8 million: a few
  // leaves far apart are no reason to clear a quarter of a gigabyte per direction.
  std::uint64_t max_cells = 64ull << 20;
  // Only max_cells limits the number of cells.
  bool keep_cell = false;
  double margin_m = 0;  // around everything, in a scene without a period
  // Where leaf_cell_size() gives cells of 4 sides: wider ones, up to 1/32 of the extent, until there are no
  // more than so many per element; 0: any number.
  double most_cells_per_element = 0;
  std::optional<GridFrame> frame =
      std::nullopt;  // instead of grid_frame() of the forest, which looks at every leaf
};

class BlockerField {
 public:
  // `forest` is needed during construction only. At least one foliage element. Throws Error(kLimitExceeded)
  // above 4e9 elements.
  BlockerField(const Forest& forest, const BlockerFieldOptions& options, const RunControl& control);

  const std::vector<FieldElement>& elements() const { return elements_; }  // in ForestIndex order
  // Indexes of elements: neighbours come together, each cell's in rising order.
  const std::vector<std::uint32_t>& elements_by_cell() const { return elements_by_cell_; }
  const std::vector<FieldWood>& wood() const { return wood_; }
  const std::vector<BlockerPiece>& element_pieces() const { return element_pieces_; }  // by rising blocker
  const std::vector<BlockerPiece>& wood_pieces() const { return wood_pieces_; }
  const GridLayout& layout() const { return layout_; }
  // Area-weighted mean side of an element: root of its area, for shoots of its mean silhouette.
  double mean_side_m() const { return mean_side_m_; }

  const GridFrame& frame() const { return frame_; }
  Vec3 field_from_world(const Vec3& point_m) const { return frame_.field_from_world(point_m); }
  Vec3 field_direction(const Vec3& direction) const { return frame_.field_direction(direction); }
  bool ends_on_ground(const Vec3& direction) const { return frame_.ends_on_ground(direction); }

 private:
  friend class BlockerFieldBuilder;
  std::vector<FieldElement> elements_;
  std::vector<std::uint32_t> elements_by_cell_;
  std::vector<FieldWood> wood_;
  std::vector<BlockerPiece> element_pieces_, wood_pieces_;
  GridLayout layout_;
  double mean_side_m_ = 0;
  GridFrame frame_;
};

}  // namespace sunfleck
