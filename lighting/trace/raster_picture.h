// One whole picture of the sun: all tiles, in parts that keep within a memory limit.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/trace/raster_project.h"
#include "lighting/trace/raster_tile.h"
#include "sim/base/run_control.h"

namespace sunfleck::trace {

struct SunPicture {
  std::vector<SunTally> tallies;  // per element
  // Per element that may cover no pixel: transmittance at a random point of it; negative: not looked up.
  std::vector<float> looked_up;
};

class PicturePainter {
 public:
  // All must outlive the painter. `limit_bytes`: of records and tiles.
  PicturePainter(const Forest& forest, const ForestIndex& index, std::uint64_t limit_bytes);

  SunPicture paint(const RasterView& view, std::uint64_t seed, const RunControl& control) const;

 private:
  // Trees with the number of their records that fall into a part, about.
  struct Part {
    PixelBox box;
    std::vector<std::uint32_t> trees;
  };

  std::vector<Part> parts_of(const RasterView& view, const std::vector<PlacedTree>& trees) const;
  double records_in(const RasterView& view, const std::vector<PlacedTree>& trees, const Part& part) const;
  RasterScene project(const RasterView& view, const std::vector<PlacedTree>& trees, const Part& part,
                      const RunControl& control) const;
  void paint_part(const RasterView& view, const std::vector<PlacedTree>& trees, const Part& part,
                  std::uint64_t seed, SunPicture& picture, const RunControl& control) const;

  const Forest& forest_;
  const ForestIndex& index_;
  std::uint64_t limit_bytes_;
  std::vector<Box> boxes_;  // of the prototypes
};

}  // namespace sunfleck::trace
