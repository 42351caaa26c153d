#include "lighting/render/raster_trees.h"

#include <algorithm>
#include <cmath>

#include "lighting/render/camera_rays.h"

namespace sunfleck {
namespace {

// Heights above the ground between which trees are, and how far they reach from their feet.
struct Slab {
  double lowest_m = 0, highest_m = 0, reach_m = 0;
};
Slab slab_of(const Forest& forest) {
  Slab slab;
  const Vec3 n = forest.terrain.normal();
  const double rise = std::hypot(n.x, n.y) / n.z;
  std::vector<Box> boxes;
  std::vector<double> reaches_m;
  for (const Prototype& p : forest.prototypes) {
    boxes.push_back(prototype_bounds(p));
    reaches_m.push_back(prototype_reach_m(p));
  }
  for (const Instance& i : forest.instances) {
    const Box& box = boxes[i.prototype.value];
    if (box.empty()) continue;
    const double reach = i.scale * reaches_m[i.prototype.value];
    const double foot = i.position_m.z - forest.terrain.height_at(i.position_m.x, i.position_m.y);
    slab.lowest_m = std::min(slab.lowest_m, foot + i.scale * box.lo.z - rise * reach);
    slab.highest_m = std::max(slab.highest_m, foot + i.scale * box.hi.z + rise * reach);
    slab.reach_m = std::max(slab.reach_m, reach);
  }
  return slab;
}

PictureExtent extent_in(const RasterFrame& frame, const PlacedView& view, const Box& box) {
  const Vec3 middle = view.point(Vec3f(box.centre()));
  const Vec3 reach = view.reach(0.5 * box.size() + 1e-6 * (glm::abs(box.lo) + glm::abs(box.hi)));
  return extent_of(frame, middle - reach, middle + reach);
}

}  // namespace

Vec3 shift_of(const Forest& forest, const RasterCell& cell) {
  if (!forest.period) return Vec3(0.0);
  const Vec2 aside = Vec2(cell.x, cell.y) * forest.period->size_m;
  return {aside.x, aside.y, forest.terrain.height_at(aside.x, aside.y) - forest.terrain.height_at(0, 0)};
}

RasterCell cell_at(const Forest& forest, const Vec3& p) {
  if (!forest.period) return {};
  const Vec2 cell = glm::floor((Vec2(p) - forest.period->origin_m) / forest.period->size_m);
  return {static_cast<std::int32_t>(cell.x), static_cast<std::int32_t>(cell.y)};
}

std::size_t SeenTrees::tree_of(std::uint32_t number) const {
  const auto after =
      std::upper_bound(trees.begin(), trees.end(), number,
                       [](std::uint32_t n, const SeenTree& t) { return n < t.placed.first_number; });
  return static_cast<std::size_t>(after - trees.begin()) - 1;
}

// All rays of a camera lie between those of its picture's corners: where these all fall, or all climb, they
// leave the slab of the trees at bounded distances.
std::optional<CellRange> cells_seen(const Forest& forest, const Camera& camera, std::uint64_t most) {
  if (!forest.period) return CellRange{};
  const Slab slab = slab_of(forest);
  const CameraRays rays(camera);
  const Vec3 up = forest.terrain.normal() / forest.terrain.normal().z;
  Box seen;
  int climbing = 0;
  for (const Vec2 corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
    const auto ray = rays.through(corner.x * camera.width_px, corner.y * camera.height_px);
    const double climb = glm::dot(ray->direction, up);
    const double height = ray->origin_m.z - forest.terrain.height_at(ray->origin_m.x, ray->origin_m.y);
    if (std::abs(climb) < 1e-3) return std::nullopt;
    climbing += climb > 0.0 ? 1 : -1;
    const double leaves = ((climb > 0.0 ? slab.highest_m : slab.lowest_m) - height) / climb;
    seen.include(ray->origin_m);
    seen.include(ray->origin_m + std::max(0.0, leaves) * ray->direction);
  }
  if (std::abs(climbing) != 4) return std::nullopt;
  const Vec3 reach(slab.reach_m, slab.reach_m, 0.0);
  // A tree's foot may lie anywhere in its cell, or beside it.
  Box feet;
  for (const Instance& i : forest.instances) feet.include(i.position_m);
  if (feet.empty()) return CellRange{};
  const Vec2 size = forest.period->size_m;
  const auto first = [&](int a) { return std::floor((seen.lo[a] - reach[a] - feet.hi[a]) / size[a]); };
  const auto last = [&](int a) { return std::ceil((seen.hi[a] + reach[a] - feet.lo[a]) / size[a]); };
  const double count = (last(0) - first(0) + 1) * (last(1) - first(1) + 1);
  if (!(count <= static_cast<double>(most))) return std::nullopt;
  const auto whole = [](double v) { return static_cast<std::int32_t>(v); };
  return CellRange{{whole(first(0)), whole(first(1))}, {whole(last(0)), whole(last(1))}};
}

std::optional<SeenTrees> trees_seen(const Forest& forest, const FigureTable& table, const RasterFrame& frame,
                                    const CellRange& cells, double width_px, double height_px,
                                    std::size_t most_trees) {
  SeenTrees seen;
  for (std::int32_t y = cells.first.y; y <= cells.last.y; ++y)
    for (std::int32_t x = cells.first.x; x <= cells.last.x; ++x) {
      const Vec3 shift = shift_of(forest, {x, y});
      for (std::uint32_t i = 0; i < forest.instances.size(); ++i) {
        const Instance& at = forest.instances[i];
        const PrototypeFigures& figures = table.of(at.prototype);
        if (figures.clusters.empty()) continue;
        const PlacedView view(frame, at, shift);
        const PictureExtent e = extent_in(frame, view, figures.box);
        if (!e.seen || e.x_hi < 0.0 || e.y_hi < 0.0 || e.x_lo > width_px || e.y_lo > height_px) continue;
        if (seen.trees.size() >= most_trees) return std::nullopt;
        seen.trees.push_back({{i, 0, shift, &figures}, {x, y}, view, e});
      }
    }
  std::stable_sort(seen.trees.begin(), seen.trees.end(), [](const SeenTree& a, const SeenTree& b) {
    return a.extent.nearness > b.extent.nearness;
  });
  for (SeenTree& t : seen.trees) {
    t.placed.first_number = static_cast<std::uint32_t>(seen.figures);
    seen.figures += t.placed.figures->count();
    if (seen.figures > kMostNumbers) return std::nullopt;
  }
  return seen;
}

}  // namespace sunfleck
