// Draws clusters of figures into a picture whose places lie in bins (pixels of a tile, or cells of the sun's
// view): what both passes share.
//
// Bins:  width(), height()                       whole bins
//        run(row, x_begin, x_end) -> PlaceRun    the places of a row's bins, one after the other
//        hidden(extent)                          nothing of the extent can be met: skip it
//        begin(run, number, outline)             what follows belongs to this figure and run
//        met(first, mask, nearness, a, b)        see raster_kernels.h
#pragma once

#include "lighting/render/raster_kernels.h"

namespace sunfleck {

// Whole bins that an extent touches, inside the picture.
struct BinBox {
  std::int32_t x0, y0, x1, y1;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};
inline BinBox bins_of(const PictureExtent& e, std::int32_t width, std::int32_t height) {
  const auto low = [](double v, std::int32_t most) {
    return static_cast<std::int32_t>(std::clamp(std::floor(v), 0.0, static_cast<double>(most)));
  };
  // A thousandth of a bin more for the rounding of places to single precision.
  return {low(e.x_lo - 1e-3, width), low(e.y_lo - 1e-3, height), low(e.x_hi + 1.001, width),
          low(e.y_hi + 1.001, height)};
}

template <class Bins>
class FigureDrawing {
 public:
  FigureDrawing(const RasterFrame& frame, const FigureTable& table, Bins& bins)
      : frame_(frame),
        table_(table),
        bins_(bins),
        range_{static_cast<float>(frame.nearest), frame.perspective,
               frame.perspective || frame.nearest <= 0.0} {}

  PictureExtent extent(const PlacedView& view, const FigureCluster& cluster) const {
    const Vec3 c = view.point(cluster.centre), reach(view.scale * cluster.radius);
    return extent_of(frame_, c - reach, c + reach);
  }

  void draw(const PlacedFigures& tree, const PlacedView& view, const FigureCluster& cluster) {
    const PrototypeFigures& figures = *tree.figures;
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      if (cluster.flat)
        draw_flat(view, figures.flats[i], tree.first_number + i);
      else
        draw_round(view, figures.rounds[i],
                   tree.first_number + static_cast<std::uint32_t>(figures.flats.size()) + i);
    }
  }

 private:
  template <class Meet>
  void for_each_run(const BinBox& box, const RowCuts& cuts, std::uint32_t number, const OutlineTable* outline,
                    const Meet& meet) {
    for (std::int32_t row = box.y0; row < box.y1; ++row) {
      auto lo = 0.0f, hi = static_cast<float>(box.x1 - box.x0);
      cuts.cut(static_cast<float>(row - box.y0), lo, hi);
      const std::int32_t begin = box.x0 + static_cast<std::int32_t>(std::max(0.0f, lo - 1e-3f));
      const std::int32_t end =
          box.x0 +
          static_cast<std::int32_t>(std::ceil(std::min(hi + 1e-3f, static_cast<float>(box.x1 - box.x0))));
      if (begin >= end) continue;
      PlaceRun run = bins_.run(row, begin, end);
      if (run.count == 0) continue;
      run.corner_x = static_cast<float>(box.x0), run.corner_y = static_cast<float>(box.y0);
      bins_.begin(run, number, outline);
      meet(run);
    }
  }

  void draw_flat(const PlacedView& view, const FlatFigure& figure, std::uint32_t number) {
    const Vec3 c = view.point(figure.centre), u = view.direction(figure.u), v = view.direction(figure.v);
    Vec3 lo, hi;
    if (figure.shape == FlatShape::kTriangle) {
      lo = glm::min(c, glm::min(c + u, c + v)), hi = glm::max(c, glm::max(c + u, c + v));
    } else {
      const Vec3 reach =
          figure.shape == FlatShape::kDisc ? glm::sqrt(u * u + v * v) : glm::abs(u) + glm::abs(v);
      lo = c - reach, hi = c + reach;
    }
    const PictureExtent extent = extent_of(frame_, lo, hi);
    const BinBox box = bins_of(extent, bins_.width(), bins_.height());
    if (!extent.seen || box.empty() || bins_.hidden(box, extent.nearness)) return;
    const auto forms = flat_forms(frame_, c, u, v, {box.x0, box.y0});
    if (!forms) return;
    RowCuts cuts;
    if (box.x1 - box.x0 > 2) cuts = cuts_of(*forms, figure.shape, frame_.perspective);
    for_each_run(box, cuts, number, table_.outline(figure), [&](const PlaceRun& run) {
      switch (figure.shape) {
        case FlatShape::kParallelogram:
          return meet_flat<FlatShape::kParallelogram>(*forms, run, range_, bins_);
        case FlatShape::kDisc:
          return meet_flat<FlatShape::kDisc>(*forms, run, range_, bins_);
        case FlatShape::kTriangle:
          return meet_flat<FlatShape::kTriangle>(*forms, run, range_, bins_);
      }
    });
  }

  // Drawn as a strip through its axis that faces the view: the same silhouette but for the taper (the mean
  // radius) and slanted ends, and at most its radius too far away.
  bool is_thin(double widest_m, const PictureExtent& extent) const {
    constexpr double kThinPx = 0.5, kThinForSun_m = 0.01;
    if (!range_.ahead_only) return widest_m < kThinForSun_m;
    return widest_m * frame_.px_per_unit * (frame_.perspective ? extent.nearness : 1.0) < kThinPx;
  }

  void draw_round(const PlacedView& view, const RoundFigure& figure, std::uint32_t number) {
    const Vec3 base = view.point(figure.base), axis = view.direction(figure.axis) / view.scale;
    const double length = view.scale * figure.length;
    const double widest = view.scale * std::max(figure.radius, figure.radius + figure.taper * figure.length);
    const Vec3 tip = base + length * axis;
    const Vec3 reach = widest * glm::sqrt(glm::max(Vec3(0), 1.0 - axis * axis)) + 1e-9 * length;
    const PictureExtent extent = extent_of(frame_, glm::min(base, tip) - reach, glm::max(base, tip) + reach);
    const BinBox box = bins_of(extent, bins_.width(), bins_.height());
    if (!extent.seen || box.empty() || bins_.hidden(box, extent.nearness)) return;
    const Vec2 corner(box.x0, box.y0);
    if (figure.extinction_per_m == 0.0f && is_thin(widest, extent)) {
      const Vec3 middle = 0.5 * (base + tip), sight = frame_.perspective ? middle : Vec3(0, 0, 1);
      const Vec3 aside = glm::cross(axis, sight);
      const double sine = glm::length(aside);
      if (!(sine > 1e-6 * glm::length(sight))) return;
      const double radius = view.scale * (figure.radius + 0.5 * figure.taper * figure.length);
      const auto strip = flat_forms(frame_, middle, 0.5 * length * axis, radius / sine * aside, corner);
      if (!strip) return;
      RowCuts cuts;
      if (box.x1 - box.x0 > 2) cuts = cuts_of(*strip, FlatShape::kParallelogram, frame_.perspective);
      return for_each_run(box, cuts, number, nullptr, [&](const PlaceRun& run) {
        meet_flat<FlatShape::kParallelogram>(*strip, run, range_, bins_);
      });
    }
    const RoundForms forms = round_forms(frame_, figure, base, axis, view.scale, corner);
    RowCuts cuts;
    // A shoot's caps reach past the band of its axis; wood has none.
    if (box.x1 - box.x0 > 2 && figure.extinction_per_m == 0.0f)
      cuts = cuts_of(frame_, base, tip, widest, corner);
    for_each_run(box, cuts, number, nullptr, [&](const PlaceRun& run) {
      if (figure.extinction_per_m > 0.0f)
        meet_shoot(forms, 0x9E3779B9u * number + 0x7F4A7C15u, run, range_, bins_);
      else
        meet_cone(forms, run, range_, bins_);
    });
  }

  const RasterFrame& frame_;
  const FigureTable& table_;
  Bins& bins_;
  SeenRange range_;
};

}  // namespace sunfleck
