// Which trees, and which copies of them in other periods, a camera or the sun may see: placed, with numbers
// for their figures, the nearest first.
#pragma once

#include <optional>
#include <span>

#include "lighting/render/raster_forms.h"

namespace sunfleck {

inline constexpr std::uint32_t kSkyNumber = 0xFFFFFFFFu, kGroundNumber = 0xFFFFFFFEu;
inline constexpr std::uint64_t kMostNumbers = 0xFFFFFF00u;

// Whole periods from the base cell.
struct RasterCell {
  std::int32_t x = 0, y = 0;
  bool operator==(const RasterCell&) const = default;
};
// On slopes copies follow the ground.
Vec3 shift_of(const Forest& forest, const RasterCell& cell);
RasterCell cell_at(const Forest& forest, const Vec3& point_m);

struct SeenTree {
  PlacedFigures placed;
  RasterCell cell;
  PlacedView view;
  PictureExtent extent;
};

struct SeenTrees {
  std::vector<SeenTree> trees;  // by nearness; numbers rise in this order
  std::uint64_t figures = 0;    // of all of them
  // The tree of a figure's number.
  std::size_t tree_of(std::uint32_t number) const;
};

// Cells of the period that a range of heights above the ground may be seen in; none where the view has no
// end (a periodic forest seen towards the horizon) or holds more than `most` cells.
struct CellRange {
  RasterCell first, last;
  std::uint64_t count() const {
    return static_cast<std::uint64_t>(last.x - first.x + 1) *
           static_cast<std::uint64_t>(last.y - first.y + 1);
  }
};
std::optional<CellRange> cells_seen(const Forest& forest, const Camera& camera, std::uint64_t most);

// All trees of the cells that may touch the picture of the frame, `width_px` x `height_px` from (0, 0).
// Nothing where their figures are more than can be numbered, or more than `most_trees`.
std::optional<SeenTrees> trees_seen(const Forest& forest, const FigureTable& table, const RasterFrame& frame,
                                    const CellRange& cells, double width_px, double height_px,
                                    std::size_t most_trees);

}  // namespace sunfleck
