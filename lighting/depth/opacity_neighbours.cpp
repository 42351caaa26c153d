// Sums of optical depth over neighbouring instances; see opacity_neighbours.h.
#include "lighting/depth/opacity_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr double kMostCopies = 32;

bool overlap(const Vec2& lo_a, const Vec2& hi_a, const Vec2& lo_b, const Vec2& hi_b) {
  return lo_a.x <= hi_b.x && lo_b.x <= hi_a.x && lo_a.y <= hi_b.y && lo_b.y <= hi_a.y;
}

bool inside(const Vec2& p, const Vec2& lo, const Vec2& hi) {
  return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y;
}

// Around the turned and moved corners of the prototype's box, in the coordinates that `coordinates` gives
// them.
template <class Coordinates>
Box box_around(const PlacedMap& placed, const Coordinates& coordinates) {
  Box box;
  const Box& b = placed.bounds_m;
  if (b.empty()) return box;
  for (int corner = 0; corner < 8; ++corner)
    box.include(coordinates(placed.world_from_tree(
        {corner & 1 ? b.hi.x : b.lo.x, corner & 2 ? b.hi.y : b.lo.y, corner & 4 ? b.hi.z : b.lo.z})));
  return box;
}

int copies_for(double reach_m, double size_m, double period_m, bool& complete) {
  const double copies = std::ceil((reach_m + size_m) / period_m);
  complete = complete && copies <= kMostCopies;
  return static_cast<int>(std::min(copies, kMostCopies));
}

}  // namespace

CopyReach copy_reach(const Forest& forest, const Box& bounds_m, const Vec3& to_light) {
  CopyReach reach;
  if (!forest.period || bounds_m.empty()) return reach;
  // A line inside the layer of trees over the ground's plane leaves it after height / cosine.
  const Vec3 size = bounds_m.size();
  const Vec3 normal = forest.terrain.normal();
  const double height_m =
      size.z + std::hypot(size.x, size.y) * std::sqrt(std::max(0.0, 1 - normal.z * normal.z));
  const double length_m = height_m / std::max(std::abs(glm::dot(to_light, normal)), 1e-12);
  reach.copies_x =
      copies_for(length_m * std::abs(to_light.x), size.x, forest.period->size_m.x, reach.complete);
  reach.copies_y =
      copies_for(length_m * std::abs(to_light.y), size.y, forest.period->size_m.y, reach.complete);
  return reach;
}

OpacityNeighbours::OpacityNeighbours(const Forest& forest, std::span<const PlacedMap> placed,
                                     const Vec3& to_light)
    : placed_(placed), axes_(light_axes(to_light)) {
  SUNFLECK_EXPECTS(placed.size() == forest.instances.size());
  Box bounds;
  for (const PlacedMap& p : placed) {
    own_.push_back(rectangle_of(p));
    bounds.include(box_around(p, [](const Vec3& corner) { return corner; }));
  }
  reach_ = copy_reach(forest, bounds, to_light);
  add_copies(forest, own_);
  fill_buckets();
}

// With the two texels by which a map spills over; infinite and inverted where there is nothing.
OpacityNeighbours::Rectangle OpacityNeighbours::rectangle_of(const PlacedMap& placed) const {
  const Box box = box_around(placed, [&](const Vec3& corner) { return along(axes_, corner); });
  const double spill_m = 2.0 * placed.scale * placed.map->layout().texel_m;
  return {{box.lo.x - spill_m, box.lo.y - spill_m}, {box.hi.x + spill_m, box.hi.y + spill_m}};
}

// Originals, then every copy that overlaps the rectangle around all originals.
void OpacityNeighbours::add_copies(const Forest& forest, std::span<const Rectangle> own) {
  all_ = {Vec2(std::numeric_limits<double>::infinity()), Vec2(-std::numeric_limits<double>::infinity())};
  for (std::size_t i = 0; i < own.size(); ++i) {
    entries_.push_back({static_cast<std::uint32_t>(i), Vec3(0.0), own[i].lo, own[i].hi});
    all_.lo = glm::min(all_.lo, own[i].lo);
    all_.hi = glm::max(all_.hi, own[i].hi);
  }
  for (int kx = -reach_.copies_x; kx <= reach_.copies_x; ++kx)
    for (int ky = -reach_.copies_y; ky <= reach_.copies_y; ++ky) {
      if (kx == 0 && ky == 0) continue;
      const double x = kx * forest.period->size_m.x, y = ky * forest.period->size_m.y;
      const Vec3 shift(x, y, forest.terrain.height_at(x, y) - forest.terrain.height_at(0.0, 0.0));
      const Vec3 moved = along(axes_, shift);
      const Vec2 d(moved.x, moved.y);
      if (!overlap(all_.lo + d, all_.hi + d, all_.lo, all_.hi)) continue;
      for (std::size_t i = 0; i < own.size(); ++i)
        if (overlap(own[i].lo + d, own[i].hi + d, all_.lo, all_.hi))
          entries_.push_back({static_cast<std::uint32_t>(i), shift, own[i].lo + d, own[i].hi + d});
    }
}

template <class Visit>
void OpacityNeighbours::for_each_bucket(const Vec2& lo, const Vec2& hi, const Visit& visit) const {
  const Vec2 size = glm::max(all_.hi - all_.lo, Vec2(1e-12));
  const auto bucket = [&](double v, double first, double extent) {
    const double last = static_cast<double>(side_ - 1);
    return static_cast<std::size_t>(
        std::clamp(std::floor((v - first) / extent * static_cast<double>(side_)), 0.0, last));
  };
  const std::size_t i0 = bucket(lo.x, all_.lo.x, size.x), i1 = bucket(hi.x, all_.lo.x, size.x);
  const std::size_t j0 = bucket(lo.y, all_.lo.y, size.y), j1 = bucket(hi.y, all_.lo.y, size.y);
  for (std::size_t j = j0; j <= j1; ++j)
    for (std::size_t i = i0; i <= i1; ++i) visit(j * side_ + i);
}

void OpacityNeighbours::fill_buckets() {
  side_ = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(entries_.size())), 1.0, 512.0));
  bucket_first_.assign(side_ * side_ + 1, 0);
  for (const Neighbour& e : entries_)
    if (e.lo.x <= e.hi.x) for_each_bucket(e.lo, e.hi, [&](std::size_t b) { ++bucket_first_[b + 1]; });
  for (std::size_t b = 1; b < bucket_first_.size(); ++b) bucket_first_[b] += bucket_first_[b - 1];
  bucket_entries_.resize(bucket_first_.back());
  std::vector<std::uint32_t> next(bucket_first_.begin(), bucket_first_.end() - 1);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Neighbour& e = entries_[i];
    if (e.lo.x <= e.hi.x)
      for_each_bucket(e.lo, e.hi,
                      [&](std::size_t b) { bucket_entries_[next[b]++] = static_cast<std::uint32_t>(i); });
  }
}

std::vector<Neighbour> OpacityNeighbours::around(std::size_t instance) const {
  const Rectangle& own = own_[instance];
  std::vector<std::uint32_t> found;
  if (own.lo.x <= own.hi.x)
    for_each_bucket(own.lo, own.hi, [&](std::size_t b) {
      for (std::uint32_t k = bucket_first_[b]; k < bucket_first_[b + 1]; ++k) {
        const Neighbour& e = entries_[bucket_entries_[k]];
        if (bucket_entries_[k] != instance && overlap(e.lo, e.hi, own.lo, own.hi))
          found.push_back(bucket_entries_[k]);
      }
    });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<Neighbour> neighbours;
  for (const std::uint32_t k : found) neighbours.push_back(entries_[k]);
  return neighbours;
}

OpticalDepths OpacityNeighbours::at(std::span<const Neighbour> neighbours, const Vec3& point_m) const {
  const Vec2 across(glm::dot(axes_.across, point_m), glm::dot(axes_.upwards, point_m));
  OpticalDepths sum;
  for (const Neighbour& n : neighbours) {
    if (!inside(across, n.lo, n.hi)) continue;
    const PlacedMap& placed = placed_[n.placed];
    const OpticalDepths depths = placed.map->at(placed.tree_from_world(point_m - n.shift_m));
    sum.before += depths.before;
    sum.behind += depths.behind;
  }
  return sum;
}

void OpacityNeighbours::add_at(std::span<const Neighbour> neighbours, const PlacedMap& own,
                               std::span<const float> x, std::span<const float> y, std::span<const float> z,
                               std::span<float> before, std::span<float> behind) const {
  for (const Neighbour& n : neighbours) {
    const PlacedMap& placed = placed_[n.placed];
    // Own frame to texels, by what it does to the origin and the axes.
    const auto texel = [&](const Vec3& p) {
      return placed.map->texel_from_tree(placed.tree_from_world(own.world_from_tree(p) - n.shift_m));
    };
    const Vec3 zero = texel(Vec3(0.0));
    const std::array<Vec3, 4> columns{texel({1, 0, 0}) - zero, texel({0, 1, 0}) - zero,
                                      texel({0, 0, 1}) - zero, zero};
    AffineFloat map_from_own;
    for (int row = 0; row < 3; ++row)
      for (std::size_t c = 0; c < 4; ++c)
        map_from_own.row[static_cast<std::size_t>(row)][c] = static_cast<float>(columns[c][row]);
    placed.map->add_at(map_from_own, x, y, z, before, behind);
  }
}

}  // namespace sunfleck
