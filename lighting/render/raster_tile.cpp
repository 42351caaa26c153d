#include "lighting/render/raster_tile.h"

#include <algorithm>

#include "lighting/render/raster_samples.h"

namespace sunfleck {
namespace {

constexpr std::int32_t kBlockPx = 8;
constexpr int kClustersBetweenLooks = 48;

}  // namespace

void VisibleTile::start(const RasterFrame& frame, const Terrain& terrain, const PixelTile& tile,
                        const TileSamples& samples, std::int32_t picture_width_px) {
  tile_ = tile;
  frame_ = frame.moved({tile.x0, tile.y0});
  per_pixel_ = samples.per_pixel();
  // Runs of eight may end past the last sample.
  const std::size_t count = index(0, tile.height(), 0), room = count + kLanes;
  for (auto* v : {&x_, &y_, &nearness_}) v->resize(room);
  for (auto* v : {&lot_, &number_}) v->resize(room);
  std::fill(nearness_.begin(), nearness_.end(), static_cast<float>(frame.farthest));
  std::fill(number_.begin(), number_.end(), kSkyNumber);
  place_samples(samples, picture_width_px);
  lay_ground(terrain);
  blocks_across_ = (tile.width() + kBlockPx - 1) / kBlockPx;
  farthest_.assign(static_cast<std::size_t>(blocks_across_ * ((tile.height() + kBlockPx - 1) / kBlockPx)), 0);
  find_farthest();
}

void VisibleTile::place_samples(const TileSamples& samples, std::int32_t picture_width_px) {
  std::size_t i = 0;
  for (std::int32_t y = 0; y < tile_.height(); ++y)
    for (std::int32_t x = 0; x < tile_.width(); ++x) {
      const std::uint64_t pixel =
          static_cast<std::uint64_t>(tile_.y0 + y) * static_cast<std::uint64_t>(picture_width_px) +
          static_cast<std::uint64_t>(tile_.x0 + x);
      const auto put = [&](double in_x, double in_y, std::uint32_t lot) {
        x_[i] = static_cast<float>(x + in_x), y_[i] = static_cast<float>(y + in_y), lot_[i] = lot;
        ++i;
      };
      for (std::uint32_t unit = samples.first_unit; unit < samples.end_unit; ++unit) {
        const SamplePlaces places(samples.seed, pixel, unit);
        for (std::uint32_t s = 0; s < samples.per_unit; ++s) {
          const auto at = places.at(s);
          put(at[0], at[1], places.lot(s));
        }
      }
      if (samples.centre) put(0.5, 0.5, static_cast<std::uint32_t>(0x2545F491u * pixel));
    }
}

// An endless plane: only how near it is matters.
void VisibleTile::lay_ground(const Terrain& terrain) {
  const Basis along = basis_around(terrain.normal());
  const auto forms = flat_forms(frame_, frame_.from_world({0, 0, terrain.height_at(0, 0)}),
                                frame_.turned(along.tangent), frame_.turned(along.bitangent), Vec2(0.0));
  if (!forms) return;
  const LinearForm& f = forms->nearness;
  const auto nearest = static_cast<float>(frame_.nearest);
  for (std::size_t i = 0; i < number_.size() - kLanes; ++i) {
    const float near = f.at_corner + f.per_x * x_[i] + f.per_y * y_[i];
    if (!(near > nearness_[i] && near <= nearest)) continue;
    nearness_[i] = near;
    number_[i] = kGroundNumber;
  }
}

void VisibleTile::find_farthest() {
  for (std::int32_t y0 = 0, block_row = 0; y0 < tile_.height(); y0 += kBlockPx, ++block_row)
    for (std::int32_t x0 = 0, block = 0; x0 < tile_.width(); x0 += kBlockPx, ++block) {
      float farthest = std::numeric_limits<float>::infinity();
      const std::int32_t x1 = std::min(x0 + kBlockPx, tile_.width());
      for (std::int32_t y = y0; y < std::min(y0 + kBlockPx, tile_.height()); ++y)
        for (std::size_t i = index(x0, y, 0), end = index(x1, y, 0); i < end; ++i)
          farthest = nearness_[i] < farthest ? nearness_[i] : farthest;
      farthest_[static_cast<std::size_t>(block_row * blocks_across_ + block)] = farthest;
    }
}

bool VisibleTile::hidden(const BinBox& box, double nearness) const {
  for (std::int32_t row = box.y0 / kBlockPx; row <= (box.y1 - 1) / kBlockPx; ++row)
    for (std::int32_t column = box.x0 / kBlockPx; column <= (box.x1 - 1) / kBlockPx; ++column)
      if (nearness > static_cast<double>(farthest_[static_cast<std::size_t>(row * blocks_across_ + column)]))
        return false;
  return true;
}

void VisibleTile::met(std::int32_t first, IntLanes mask, const FloatLanes& near, const FloatLanes& a,
                      const FloatLanes& b) {
  const std::size_t at = offset_ + static_cast<std::size_t>(first);
  FloatLanes shown;
  trace::load(shown, &nearness_[at]);
  mask &= near > shown;
  if (!any(mask)) return;
  if (outline_ != nullptr) {
    for (int i = 0; i < kLanes; ++i) {
      if (mask[i] == 0) continue;
      const float most = frame_.perspective ? near[i] : 1.0f;
      if (!outline_->is_inside(a[i] / most, b[i] / most)) continue;
      nearness_[at + static_cast<std::size_t>(i)] = near[i];
      number_[at + static_cast<std::size_t>(i)] = drawn_;
    }
    return;
  }
  IntLanes numbers;
  trace::load(numbers, &number_[at]);
  shown = mask ? near : shown;
  numbers = mask ? static_cast<std::int32_t>(drawn_) - IntLanes{} : numbers;
  std::memcpy(&nearness_[at], &shown, sizeof shown);
  std::memcpy(&number_[at], &numbers, sizeof numbers);
}

void VisibleTile::draw(const SeenTrees& trees, const FigureTable& table, const RunControl& control) {
  FigureDrawing drawing(frame_, table, *this);
  int since_look = 0;
  for (const SeenTree& tree : trees.trees) {
    PictureExtent e = tree.extent;
    e.x_lo -= tile_.x0, e.x_hi -= tile_.x0, e.y_lo -= tile_.y0, e.y_hi -= tile_.y0;
    const BinBox box = bins_of(e, width(), height());
    if (box.empty() || hidden(box, e.nearness)) continue;
    control.check();
    const std::vector<FigureCluster>& clusters = tree.placed.figures->clusters;
    order_.clear();
    for (std::uint32_t c = 0; c < clusters.size(); ++c) {
      const PictureExtent extent = drawing.extent(tree.view, clusters[c]);
      const BinBox touched = bins_of(extent, width(), height());
      if (extent.seen && !touched.empty() && !hidden(touched, extent.nearness))
        order_.emplace_back(-static_cast<float>(extent.nearness), c);
    }
    std::sort(order_.begin(), order_.end());
    for (const auto& [behind, c] : order_) {
      if (++since_look == kClustersBetweenLooks) find_farthest(), since_look = 0;
      drawing.draw(tree.placed, tree.view, clusters[c]);
    }
  }
}

}  // namespace sunfleck
