#include "lighting/trace/raster_bins.h"

#include "lighting/trace/raster_tile.h"

namespace sunfleck::trace {

template <class Visit>
void RasterBins::for_each_tile(const PixelBox& bounds, Visit&& visit) const {
  const PixelBox b = common(bounds, part_);
  if (b.empty()) return;
  for (std::int32_t j = (b.v_lo - part_.v_lo) / kTileSide; j <= (b.v_hi - 1 - part_.v_lo) / kTileSide; ++j)
    for (std::int32_t i = (b.u_lo - part_.u_lo) / kTileSide; i <= (b.u_hi - 1 - part_.u_lo) / kTileSide; ++i)
      visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i));
}

RasterBins::RasterBins(const std::vector<RasterRecord>& records, const PixelBox& part)
    : part_(part),
      columns_((part.u_hi - part.u_lo + kTileSide - 1) / kTileSide),
      rows_((part.v_hi - part.v_lo + kTileSide - 1) / kTileSide),
      first_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0) {
  for (const RasterRecord& r : records) for_each_tile(r.bounds, [&](std::size_t t) { ++first_[t + 1]; });
  for (std::size_t t = 0; t + 1 < first_.size(); ++t) first_[t + 1] += first_[t];
  entries_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < records.size(); ++i)
    for_each_tile(records[i].bounds,
                  [&](std::size_t t) { entries_[next[t]++] = static_cast<std::uint32_t>(i); });
}

PixelBox RasterBins::box(std::size_t tile) const {
  const auto i = static_cast<std::int32_t>(tile % static_cast<std::size_t>(columns_));
  const auto j = static_cast<std::int32_t>(tile / static_cast<std::size_t>(columns_));
  const std::int32_t u = part_.u_lo + i * kTileSide, v = part_.v_lo + j * kTileSide;
  return common({u, v, u + kTileSide, v + kTileSide}, part_);
}

}  // namespace sunfleck::trace
