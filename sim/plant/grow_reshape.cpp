#include "sim/plant/grow_reshape.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

constexpr int kRounds = 3;  // elements keep their size, so the first fit misses by a part of a leaf

// The piecewise linear map of heights that takes base to new base and top to new top.
struct HeightMap {
  double base, top, new_base, new_top;
  double operator()(double z) const {
    if (z <= base) return base > 0 ? z * (new_base / base) : z;
    return new_base + (z - base) * (new_top - new_base) / (top - base);
  }
};

template <class Move>
void move_all(Prototype& prototype, const Move& move) {
  for (FoliageElement& e : prototype.foliage) move(e.centre_m);
  for (WoodSegment& s : prototype.wood) {
    move(s.from_m);
    move(s.to_m);
  }
}

// Branches of a low crown may droop into the ground: lifts every point in proportion to its distance from the
// stem, as little as brings all foliage above `least_m`.
void lift_drooping(Prototype& prototype, double least_m) {
  double lift_per_m = 0;
  for (const FoliageElement& e : prototype.foliage) {
    const double reach = std::hypot(double{e.centre_m.x}, double{e.centre_m.y});
    if (e.centre_m.z < least_m && reach > 0.01)
      lift_per_m = std::max(lift_per_m, (least_m - e.centre_m.z) / reach);
  }
  move_all(prototype, [&](Vec3f& point) {
    point.z += static_cast<float>(std::min(lift_per_m, 3.0) * std::hypot(double{point.x}, double{point.y}));
  });
}

void move_point(Vec3f& point, const HeightMap& height, double widen) {
  point = Vec3f(point.x * widen, point.y * widen, height(point.z));
}

}  // namespace

void reshape_to_size(Prototype& prototype, const TreeSize& size) {
  if (measure(prototype).crown_base_m < 0.3 * size.crown_base_m)
    lift_drooping(prototype, 0.5 * size.crown_base_m);
  for (int round = 0; round < kRounds; ++round) {
    const TreeMeasures now = measure(prototype);
    if (!(now.height_m > now.crown_base_m && now.crown_base_m > 0 && now.crown_radius_m > 0)) return;
    const HeightMap height{now.crown_base_m, now.height_m, size.crown_base_m, size.height_m};
    const double widen = size.crown_radius_m / now.crown_radius_m;
    move_all(prototype, [&](Vec3f& point) { move_point(point, height, widen); });
  }
}

}  // namespace sunfleck
