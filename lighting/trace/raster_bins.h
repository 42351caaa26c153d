// Which records may touch which tile of a part of the picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lighting/trace/raster_shapes.h"

namespace sunfleck::trace {

class RasterBins {
 public:
  RasterBins(const std::vector<RasterRecord>& records, const PixelBox& part);
  std::size_t tile_count() const { return first_.size() - 1; }
  PixelBox box(std::size_t tile) const;
  std::span<const std::uint32_t> records(std::size_t tile) const {
    return std::span(entries_).subspan(first_[tile], first_[tile + 1] - first_[tile]);
  }

 private:
  template <class Visit>
  void for_each_tile(const PixelBox& bounds, Visit&& visit) const;

  PixelBox part_;
  std::int32_t columns_ = 0, rows_ = 0;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> entries_;
};

}  // namespace sunfleck::trace
