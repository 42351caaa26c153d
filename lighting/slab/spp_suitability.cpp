// Crown cover and open sides; see spp_suitability.h.
#include "lighting/slab/spp_suitability.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace sunfleck {
namespace {

constexpr double kSquaresPerCrown = 16.0;
constexpr double kMostSquares = 2048.0;  // along a side

// Where foliage is, seen from above.
class Plan {
 public:
  Plan(const Vec2& lo, const Vec2& size, double square_m, bool repeats)
      : lo_(lo), size_(size), repeats_(repeats) {
    for (int axis = 0; axis < 2; ++axis)
      squares_[axis] = static_cast<int>(std::clamp(std::ceil(size[axis] / square_m), 1.0, kMostSquares));
    covered_.assign(static_cast<std::size_t>(squares_[0]) * static_cast<std::size_t>(squares_[1]), 0);
  }

  // All squares that a square of the plan of half width `half_m` around a point touches.
  void cover(double x, double y, double half_m) {
    const int x0 = square(0, x - half_m), x1 = square(0, x + half_m);
    const int y0 = square(1, y - half_m), y1 = square(1, y + half_m);
    for (int j = y0; j <= std::min(y1, y0 + squares_[1] - 1); ++j)
      for (int i = x0; i <= std::min(x1, x0 + squares_[0] - 1); ++i) mark(i, j);
  }

  double covered_share() const {
    return static_cast<double>(std::count(covered_.begin(), covered_.end(), 1)) /
           static_cast<double>(covered_.size());
  }

 private:
  int square(int axis, double v) const {
    return static_cast<int>(std::floor((v - lo_[axis]) / std::max(size_[axis], 1e-12) * squares_[axis]));
  }
  static int wrapped(int i, int n) { return ((i % n) + n) % n; }
  void mark(int i, int j) {
    if (repeats_) {
      i = wrapped(i, squares_[0]);
      j = wrapped(j, squares_[1]);
    } else if (i < 0 || j < 0 || i >= squares_[0] || j >= squares_[1]) {
      return;
    }
    covered_[static_cast<std::size_t>(j) * static_cast<std::size_t>(squares_[0]) +
             static_cast<std::size_t>(i)] = 1;
  }

  Vec2 lo_, size_;
  bool repeats_;
  int squares_[2] = {1, 1};
  std::vector<char> covered_;
};

template <class Visit>
void for_each_cell(const Forest& forest, const ForestGrids& grids, const Visit& visit) {
  for (const Instance& instance : forest.instances) {
    const PrototypeGrid& grid = grids.prototypes[instance.prototype.value];
    for (const Vec3& centre : grid.centre_m)
      visit(world_from_tree(instance, centre), 0.5 * grid.cell_m * instance.scale);
  }
}

}  // namespace

std::string SppHSuitability::reason() const {
  if (suitable()) return {};
  char text[200];
  std::snprintf(
      text, sizeof text,
      "spp_h is for closed canopies, here foliage covers %.2f of the ground (at least %.2f) and %.2f of "
      "the stand's surface are its sides (at most %.2f)",
      crown_cover, kLeastCover, open_side_share, kMostOpenSides);
  return text;
}

SppHSuitability spp_h_suitability(const Forest& forest, const ForestGrids& grids) {
  Box box;
  double crown_m = 0.0;
  for (const Instance& instance : forest.instances)
    crown_m += grids.prototypes[instance.prototype.value].cell_m * instance.scale * kSquaresPerCrown;
  for_each_cell(forest, grids, [&](const Vec3& p, double half_m) {
    box.include(p - half_m);
    box.include(p + half_m);
  });
  if (box.empty()) return {};
  crown_m /= static_cast<double>(forest.instances.size());
  const bool repeats = forest.period.has_value();
  const Vec3 size = box.size();
  const Vec2 plan_size = repeats ? forest.period->size_m : Vec2(size.x, size.y);
  Plan plan(repeats ? forest.period->origin_m : Vec2(box.lo.x, box.lo.y), plan_size,
            std::max(crown_m / kSquaresPerCrown, 1e-9), repeats);
  for_each_cell(forest, grids, [&](const Vec3& p, double half_m) { plan.cover(p.x, p.y, half_m); });
  const double sides = 2.0 * size.z * (size.x + size.y), faces = 2.0 * size.x * size.y;
  return {plan.covered_share(), repeats || !(sides > 0.0) ? 0.0 : sides / (sides + faces)};
}

SppHSuitability spp_h_suitability(const Forest& forest) {
  return spp_h_suitability(forest, make_forest_grids(forest, 16));
}

}  // namespace sunfleck
