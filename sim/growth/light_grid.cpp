#include "sim/growth/light_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr double kExtinction = 0.5;  // spherical leaf angles
constexpr double kReachShare = 0.65;
constexpr double kMostCells = 2e7;
constexpr double kDark = 12;  // optical depth beyond which nothing is left

struct SkyDirection {
  Vec3 to_sky;
  double weight;
};

std::array<SkyDirection, 13> sky_directions() {
  std::array<SkyDirection, 13> sky{};
  sky[0] = {{0, 0, 1}, 0.2};
  for (int k = 0; k < 12; ++k) {
    const bool inner = k < 4;
    const double sine = std::sqrt(inner ? 0.4 : 0.8), turn = inner ? kPi * (k + 0.5) / 2 : kPi * (k - 4) / 4;
    sky[static_cast<std::size_t>(k) + 1] = {
        {sine * std::cos(turn), sine * std::sin(turn), std::sqrt(1 - sine * sine)}, inner ? 0.1 : 0.05};
  }
  return sky;
}

bool ray_meets(const Box& box, const Vec3& from, const Vec3& way) {
  double enter = 0, leave = INFINITY;
  for (int i = 0; i < 3; ++i) {
    if (way[i] == 0 && (from[i] < box.lo[i] || from[i] > box.hi[i])) return false;
    if (way[i] == 0) continue;
    const double a = (box.lo[i] - from[i]) / way[i], b = (box.hi[i] - from[i]) / way[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

void require_size(const LightGridOptions& o) {
  const double width_m = o.period_m.value_or(2 * o.half_width_m);
  for (const double size_m : {o.cell_m, width_m, o.height_m})
    if (!(size_m > 0 && size_m < 1e4))
      throw_invalid("light grid", "a size of " + std::to_string(size_m) + " m", "metres above 0");
  if (std::pow(width_m / o.cell_m + 1, 2) * (o.height_m / o.cell_m + 1) > kMostCells)
    throw_invalid("light grid", "more than 2e7 cells", "larger cells or a smaller grid");
}

}  // namespace

LightGrid::LightGrid(LightGridOptions options) : options_(std::move(options)) {
  require_size(options_);
  width_m_ = options_.period_m.value_or(2 * options_.half_width_m);
  across_ = std::max(1, static_cast<int>(std::lround(width_m_ / options_.cell_m)));
  up_ = static_cast<int>(std::ceil(options_.height_m / options_.cell_m));
  density_per_m_.assign(
      static_cast<std::size_t>(across_) * static_cast<std::size_t>(across_) * static_cast<std::size_t>(up_),
      0.0f);
}

std::optional<std::size_t> LightGrid::cell_at(const Vec3& position_m) const {
  const double edge_m = width_m_ / across_;
  auto x = static_cast<int>(std::floor((position_m.x + 0.5 * width_m_) / edge_m));
  auto y = static_cast<int>(std::floor((position_m.y + 0.5 * width_m_) / edge_m));
  const auto z = static_cast<int>(std::floor(position_m.z / options_.cell_m));
  if (options_.period_m) {
    x = (x % across_ + across_) % across_;
    y = (y % across_ + across_) % across_;
  }
  if (x < 0 || y < 0 || z < 0 || x >= across_ || y >= across_ || z >= up_) return std::nullopt;
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(across_) +
         static_cast<std::size_t>(x);
}

void LightGrid::set_leaves(std::span<const LeafPlace> leaves) {
  std::fill(density_per_m_.begin(), density_per_m_.end(), 0.0f);
  const double edge_m = width_m_ / across_, volume_m3 = edge_m * edge_m * options_.cell_m;
  for (const LeafPlace& leaf : leaves)
    if (const auto cell = cell_at(leaf.position_m))
      density_per_m_[*cell] += static_cast<float>(leaf.area_m2 / volume_m3);
}

bool LightGrid::behind_wall(const Vec3& from_m, const Vec3& to_sky) const {
  return std::any_of(options_.walls.begin(), options_.walls.end(),
                     [&](const Box& wall) { return ray_meets(wall, from_m, to_sky); });
}

// Steps of a cell, from half a cell beyond the point's own.
double LightGrid::optical_depth(const Vec3& from_m, const Vec3& to_sky) const {
  double leaf_area = 0;  // per area across the ray
  Vec3 at = from_m + 1.0 * options_.cell_m * to_sky;
  const Vec3 step = options_.cell_m * to_sky;
  const std::optional<std::size_t> own = cell_at(from_m);
  for (; at.z < options_.height_m && kExtinction * leaf_area < kDark; at += step) {
    const auto cell = cell_at(at);
    if (!cell && !options_.period_m) break;  // out at a side
    if (cell && cell != own) leaf_area += density_per_m_[*cell] * options_.cell_m;
  }
  return kExtinction * leaf_area;
}

bool LightGrid::has_room(const Vec3& position_m) const {
  return !options_.period_m || std::hypot(position_m.x, position_m.y) <= kReachShare * *options_.period_m;
}

double LightGrid::openness(const Vec3& position_m) const {
  static const std::array<SkyDirection, 13> sky = sky_directions();
  if (position_m.z <= 0) return 0;  // in the ground
  double light = 0;
  for (const SkyDirection& direction : sky)
    if (!behind_wall(position_m, direction.to_sky))
      light += direction.weight * std::exp(-optical_depth(position_m, direction.to_sky));
  return std::min(1.0, light);  // thirteen weights add up to 1 but for rounding
}

}  // namespace sunfleck
