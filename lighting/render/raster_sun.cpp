#include "lighting/render/raster_sun.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "lighting/render/raster_draw.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr double kDisc = 0.02;  // wider than the disc of any sun that is drawn, in radians
constexpr std::size_t kMostCells = 1u << 22;
constexpr double kPointsPerCell = 2.0;
constexpr std::int32_t kCoarse = 4;  // cells along a block
constexpr float kRounding = 4e-7f;   // of the scene's extent, as in RayScene

// The points of one direction, cell by cell.
class SunCells {
 public:
  SunCells(std::span<const std::vector<SunPoint>* const> lists, float rounding_m) : rounding_m_(rounding_m) {
    measure(lists);
    sort(lists);
    find_deepest();
  }
  bool empty() const { return count_ == 0; }
  RasterFrame frame_of(RasterFrame f) const {
    f.px_per_unit = 1.0 / cell_m_;
    f.centre_px = -lo_ / cell_m_;
    return f;
  }
  std::int32_t width() const { return width_; }
  std::int32_t height() const { return height_; }
  PlaceRun run(std::int32_t row, std::int32_t begin, std::int32_t end) const {
    const std::uint32_t first = first_[cell(begin, row)], last = first_[cell(end, row)];
    return {&x_[first], &y_[first], &lot_[first], static_cast<std::int32_t>(last - first)};
  }
  bool hidden(const BinBox& box, double nearness) const {
    for (std::int32_t row = box.y0 / kCoarse; row <= (box.y1 - 1) / kCoarse; ++row)
      for (std::int32_t column = box.x0 / kCoarse; column <= (box.x1 - 1) / kCoarse; ++column)
        if (nearness > static_cast<double>(deepest_[static_cast<std::size_t>(row * blocks_across_ + column)]))
          return false;
    return true;
  }
  void tell(std::span<std::uint8_t> dark) const {
    for (std::size_t i = 0; i < count_; ++i) dark[sample_[i]] = dark_[i];
  }

  // What one thread draws.
  struct Pen {
    SunCells& cells;
    std::size_t offset = 0;
    std::uint32_t drawn = 0;
    const OutlineTable* outline = nullptr;

    std::int32_t width() const { return cells.width_; }
    std::int32_t height() const { return cells.height_; }
    PlaceRun run(std::int32_t row, std::int32_t b, std::int32_t e) const { return cells.run(row, b, e); }
    bool hidden(const BinBox& box, double nearness) const { return cells.hidden(box, nearness); }
    void begin(const PlaceRun& run, std::uint32_t number, const OutlineTable* holes) {
      offset = static_cast<std::size_t>(run.x - cells.x_.data());
      drawn = number, outline = holes;
    }
    void met(std::int32_t first, IntLanes mask, const FloatLanes& near, const FloatLanes& a,
             const FloatLanes& b) {
      const std::size_t at = offset + static_cast<std::size_t>(first);
      FloatLanes point;
      IntLanes self;
      trace::load(point, &cells.nearness_[at]);
      trace::load(self, &cells.self_[at]);
      mask &= (near > point + cells.rounding_m_) & (self != static_cast<std::int32_t>(drawn));
      if (!any(mask)) return;
      for (int i = 0; i < kLanes; ++i)
        if (mask[i] != 0 && (outline == nullptr || outline->is_inside(a[i], b[i])))
          std::atomic_ref(cells.dark_[at + static_cast<std::size_t>(i)]).store(1, std::memory_order_relaxed);
    }
  };

 private:
  std::size_t cell(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  template <class Visit>
  void for_each(std::span<const std::vector<SunPoint>* const> lists, const Visit& visit) const {
    for (const auto* list : lists)
      for (const SunPoint& p : *list) visit(p);
  }
  void measure(std::span<const std::vector<SunPoint>* const> lists);
  void sort(std::span<const std::vector<SunPoint>* const> lists);
  void find_deepest();

  float rounding_m_;
  std::size_t count_ = 0;
  double cell_m_ = 1;
  Vec2 lo_{0};
  std::int32_t width_ = 1, height_ = 1, blocks_across_ = 1;
  std::vector<std::uint32_t> first_;  // of each cell
  std::vector<float> x_, y_, nearness_;
  std::vector<std::uint32_t> self_, lot_, sample_;
  std::vector<std::uint8_t> dark_;
  std::vector<float> deepest_;  // least nearness of the points of a block of cells
};

void SunCells::measure(std::span<const std::vector<SunPoint>* const> lists) {
  Vec2 lo(1e30), hi(-1e30);
  for_each(lists, [&](const SunPoint& p) {
    const Vec2 at(p.x_m, p.y_m);
    lo = glm::min(lo, at), hi = glm::max(hi, at);
    ++count_;
  });
  if (count_ == 0) return;
  lo_ = lo;
  const Vec2 size = hi - lo;
  const double cells = std::clamp(static_cast<double>(count_) / kPointsPerCell, 1.0, double{kMostCells});
  cell_m_ = std::max({std::sqrt(size.x * size.y / cells), std::max(size.x, size.y) / cells, 1e-6});
  width_ = static_cast<std::int32_t>(size.x / cell_m_) + 1;
  height_ = static_cast<std::int32_t>(size.y / cell_m_) + 1;
}

void SunCells::sort(std::span<const std::vector<SunPoint>* const> lists) {
  first_.assign(cell(0, height_) + 1, 0);
  std::vector<std::uint32_t> cell_of(count_);
  std::size_t n = 0;
  const double per_m = 1.0 / cell_m_;
  for_each(lists, [&](const SunPoint& p) {
    const auto x = std::min(static_cast<std::int32_t>((p.x_m - lo_.x) * per_m), width_ - 1);
    const auto y = std::min(static_cast<std::int32_t>((p.y_m - lo_.y) * per_m), height_ - 1);
    ++first_[(cell_of[n++] = static_cast<std::uint32_t>(cell(x, y))) + 1];
  });
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  const std::size_t room = count_ + kLanes;
  for (auto* v : {&x_, &y_, &nearness_}) v->resize(room);
  for (auto* v : {&self_, &lot_, &sample_}) v->resize(room);
  dark_.assign(room, 0);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  n = 0;
  for_each(lists, [&](const SunPoint& p) {
    const std::size_t i = next[cell_of[n++]]++;
    x_[i] = static_cast<float>((p.x_m - lo_.x) * per_m), y_[i] = static_cast<float>((p.y_m - lo_.y) * per_m);
    nearness_[i] = p.nearness_m;
    self_[i] = p.self, lot_[i] = p.lot, sample_[i] = p.sample;
  });
}

void SunCells::find_deepest() {
  blocks_across_ = (width_ + kCoarse - 1) / kCoarse;
  deepest_.assign(static_cast<std::size_t>(blocks_across_ * ((height_ + kCoarse - 1) / kCoarse)),
                  std::numeric_limits<float>::infinity());
  for (std::int32_t y = 0; y < height_; ++y)
    for (std::int32_t x = 0; x < width_; ++x) {
      float& deepest = deepest_[static_cast<std::size_t>(y / kCoarse * blocks_across_ + x / kCoarse)];
      for (std::uint32_t i = first_[cell(x, y)]; i < first_[cell(x, y) + 1]; ++i)
        deepest = std::min(deepest, nearness_[i]);
    }
}

}  // namespace

std::optional<SunTrees> SunTrees::make(const Forest& forest, const FigureTable& table, const Vec3& to_sun) {
  SunTrees s;
  const Box bounds = forest_bounds(forest);
  if (bounds.empty()) return s;
  s.middle_m_ = bounds.centre();
  const RasterFrame frame = s.frame(to_sun);
  RasterCell lo, hi;
  if (forest.period) {
    // How far along the ground a shadow reaches from the highest top to the lowest foot.
    const Vec3 n = forest.terrain.normal();
    const double climb = glm::dot(to_sun, n) / n.z;
    const Vec2 size = forest.period->size_m;
    const double rise = std::hypot(n.x, n.y) / n.z;
    const double height = bounds.size().z + rise * (bounds.size().x + bounds.size().y);
    const Vec2 far = Vec2(to_sun) / std::max(climb, 1e-9) * height;
    // Bounds reach beyond the cell by the crowns at its borders.
    const Vec2 beyond = (Vec2(bounds.size()) - size) * 0.5 + Vec2(1.0);
    const auto cells = [&](double reach, double cell) { return std::ceil(std::max(0.0, reach) / cell); };
    const Vec2 towards(cells(std::max(0.0, far.x) + beyond.x, size.x),
                       cells(std::max(0.0, far.y) + beyond.y, size.y));
    const Vec2 away(cells(std::max(0.0, -far.x) + beyond.x, size.x),
                    cells(std::max(0.0, -far.y) + beyond.y, size.y));
    if (std::max({towards.x, towards.y, away.x, away.y}) > kMostCells) return std::nullopt;
    lo = {-static_cast<std::int32_t>(away.x), -static_cast<std::int32_t>(away.y)};
    hi = {static_cast<std::int32_t>(towards.x), static_cast<std::int32_t>(towards.y)};
  }
  for (std::uint32_t i = 0; i < forest.instances.size(); ++i) {
    s.first_copy_.push_back(s.copies_.size());
    const Instance& at = forest.instances[i];
    const PrototypeFigures& figures = table.of(at.prototype);
    if (figures.clusters.empty()) continue;
    for (std::int32_t y = lo.y; y <= hi.y; ++y)
      for (std::int32_t x = lo.x; x <= hi.x; ++x) {
        const Vec3 shift = shift_of(forest, {x, y});
        s.copies_.push_back({{x, y}, static_cast<std::uint32_t>(s.figures_)});
        s.trees_.push_back({i, static_cast<std::uint32_t>(s.figures_), shift, &figures});
        s.figures_ += figures.count();
        if (s.figures_ > kMostNumbers) return std::nullopt;
        const PlacedView view(frame, at, shift);
        const Vec3 middle = view.point(Vec3f(figures.box.centre())), reach = view.reach(figures.box.size());
        s.shade_.include(middle - reach);
        s.shade_.include(middle + reach);
      }
  }
  s.first_copy_.push_back(s.copies_.size());
  const double wider = 0.01 + kDisc * glm::length(s.shade_.size());
  s.shade_.lo -= wider, s.shade_.hi += wider;
  return s;
}

bool SunTrees::may_shade(const Vec3& p) const {
  // What is lower than all trees may still lie in their shade; what is nearer to the sun cannot.
  const double wider = kDisc * std::max(0.0, p.z - shade_.hi.z);
  return !shade_.empty() && p.x >= shade_.lo.x - wider && p.x <= shade_.hi.x + wider &&
         p.y >= shade_.lo.y - wider && p.y <= shade_.hi.y + wider && p.z >= shade_.lo.z;
}

std::uint32_t SunTrees::number_of(std::uint32_t instance, const RasterCell& cell,
                                  std::uint32_t figure) const {
  for (std::size_t c = first_copy_[instance]; c < first_copy_[instance + 1]; ++c)
    if (copies_[c].cell == cell) return copies_[c].first_number + figure;
  return kSkyNumber;
}

void find_shade(const Forest& forest, const FigureTable& table, const SunTrees& trees, const Vec3& to_sun,
                std::span<const std::vector<SunPoint>* const> points, std::span<std::uint8_t> dark,
                const RunControl& control) {
  const Box bounds = forest_bounds(forest);
  SunCells cells(points, kRounding * static_cast<float>(glm::length(bounds.size())));
  if (cells.empty()) return;
  const RasterFrame frame = cells.frame_of(trees.frame(to_sun));
  for_each_chunk(trees.trees().size(), 1, control, "", [&](std::size_t t, std::size_t) {
    const PlacedFigures& tree = trees.trees()[t];
    const PlacedView view(frame, forest.instances[tree.instance], tree.shift_m);
    SunCells::Pen pen{cells};
    FigureDrawing drawing(frame, table, pen);
    const Vec3 middle = view.point(Vec3f(tree.figures->box.centre())),
               reach = view.reach(0.5 * tree.figures->box.size() + 1e-3);
    const PictureExtent whole = extent_of(frame, middle - reach, middle + reach);
    const BinBox touched = bins_of(whole, cells.width(), cells.height());
    if (touched.empty() || cells.hidden(touched, whole.nearness)) return;
    for (const FigureCluster& cluster : tree.figures->clusters) {
      const PictureExtent extent = drawing.extent(view, cluster);
      const BinBox box = bins_of(extent, cells.width(), cells.height());
      if (!box.empty() && !cells.hidden(box, extent.nearness)) drawing.draw(tree, view, cluster);
    }
  });
  cells.tell(dark);
}

}  // namespace sunfleck
