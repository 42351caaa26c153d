// What a camera sees through the samples of one tile: for each the number of the nearest figure and its
// nearness (an item buffer: Weghorst, Hooper and Greenberg 1984, with many samples per pixel). Trees come
// nearest first; blocks of pixels remember the farthest thing they show, and clusters behind that are left
// out (hierarchical visibility: Greene, Kass and Miller 1993).
#pragma once

#include "lighting/render/raster_draw.h"
#include "lighting/render/raster_trees.h"

namespace sunfleck {

// Pixels of the picture, half-open.
struct PixelTile {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::int32_t width() const { return x1 - x0; }
  std::int32_t height() const { return y1 - y0; }
};

// Samples of a pixel: units [first_unit, end_unit), and one at its centre if asked.
struct TileSamples {
  std::uint64_t seed = 1;
  std::uint32_t first_unit = 0, end_unit = 1, per_unit = 1;
  bool centre = false;
  std::uint32_t drawn() const { return (end_unit - first_unit) * per_unit; }
  std::uint32_t per_pixel() const { return drawn() + (centre ? 1u : 0u); }
};

class VisibleTile {
 public:
  // Sky and ground everywhere. `picture_width_px` numbers the pixels for their samples.
  void start(const RasterFrame& frame, const Terrain& terrain, const PixelTile& tile,
             const TileSamples& samples, std::int32_t picture_width_px);
  void draw(const SeenTrees& trees, const FigureTable& table, const RunControl& control);

  // Of a pixel (counted in the tile) and sample: centre samples come last.
  std::size_t index(std::int32_t x, std::int32_t y, std::uint32_t sample) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(tile_.width()) +
            static_cast<std::size_t>(x)) *
               per_pixel_ +
           sample;
  }
  std::uint32_t number(std::size_t i) const { return number_[i]; }
  float nearness(std::size_t i) const { return nearness_[i]; }
  // Place in the picture, px.
  Vec2 place_px(std::size_t i) const { return {tile_.x0 + double{x_[i]}, tile_.y0 + double{y_[i]}}; }
  std::uint32_t lot(std::size_t i) const { return lot_[i]; }
  const RasterFrame& frame() const { return frame_; }  // (0, 0) is the tile's corner

  // For FigureDrawing.
  std::int32_t width() const { return tile_.width(); }
  std::int32_t height() const { return tile_.height(); }
  PlaceRun run(std::int32_t row, std::int32_t begin, std::int32_t end) const {
    const std::size_t first = index(begin, row, 0);
    return {&x_[first], &y_[first], &lot_[first],
            static_cast<std::int32_t>(static_cast<std::uint32_t>(end - begin) * per_pixel_)};
  }
  bool hidden(const BinBox& box, double nearness) const;
  void begin(const PlaceRun& run, std::uint32_t number, const OutlineTable* outline) {
    offset_ = static_cast<std::size_t>(run.x - x_.data());
    drawn_ = number;
    outline_ = outline;
  }
  void met(std::int32_t first, IntLanes mask, const FloatLanes& near, const FloatLanes& a,
           const FloatLanes& b);

 private:
  void place_samples(const TileSamples& samples, std::int32_t picture_width_px);
  void lay_ground(const Terrain& terrain);
  void find_farthest();

  PixelTile tile_;
  RasterFrame frame_;
  std::uint32_t per_pixel_ = 1;
  std::vector<float> x_, y_, nearness_;
  std::vector<std::uint32_t> lot_, number_;
  std::vector<float> farthest_;  // nearness of the farthest thing shown, per block
  std::int32_t blocks_across_ = 0;
  std::size_t offset_ = 0;
  std::uint32_t drawn_ = 0;
  const OutlineTable* outline_ = nullptr;
  std::vector<std::pair<float, std::uint32_t>> order_;
};

}  // namespace sunfleck
