// OpacityMap read at many points at once: at() and around(), their plain twins in opacity_map.cpp, without
// branches and library calls.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "lighting/depth/exp_pair.h"
#include "lighting/depth/opacity_map.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr std::size_t kAtOnce = 256;
constexpr float kMostCover = 0.99966f;
constexpr float kNoise = 2e-6f;  // of a column's depth: what differences of floats leave

struct Columns {
  const float* depth;   // [column][slice boundary]
  std::int32_t row;     // slice boundaries
  std::int32_t across;  // columns to the next row of texels
};

// Weights and place of a site.
struct Site {
  std::int32_t at;  // of the first column's upper boundary
  std::int32_t slice;
  float right, up, part;
};

struct Depths {
  float before, behind;
};

[[gnu::always_inline]] inline float least_of(float a, float b) { return a < b ? a : b; }
[[gnu::always_inline]] inline float without_noise(float depth, float total) {
  return depth > kNoise * total ? depth : 0.0f;
}

// `own`: what to leave out of each column above and below the site.
[[gnu::always_inline]] inline Depths read_site(const Columns& map, const Site& s,
                                               const std::array<Depths, 4>& own) {
  const std::array<float, 4> weight{(1.0f - s.right) * (1.0f - s.up), s.right * (1.0f - s.up),
                                    (1.0f - s.right) * s.up, s.right * s.up};
  const std::array<std::int32_t, 4> at{s.at, s.at + map.row, s.at + map.across, s.at + map.across + map.row};
  std::array<float, 4> before;
  float behind = 0.0f;
  for (std::size_t q = 0; q < 4; ++q) {
    const float low = map.depth[at[q]], high = map.depth[at[q] + 1];
    const float total = map.depth[at[q] - s.slice + map.row - 1];
    const float reached = low + s.part * (high - low);
    before[q] = without_noise(reached - own[q].before, total);
    behind += weight[q] * without_noise(total - reached - own[q].behind, total);
  }
  const float least = least_of(least_of(before[0], before[1]), least_of(before[2], before[3]));
  float passed = 0.0f;
  for (std::size_t q = 0; q < 4; ++q) passed += weight[q] * exp_pair(before[q] - least).falling;
  const float mean = least - natural_log(passed > 1e-37f ? passed : 1e-37f);
  return {mean > 0.0f ? mean : 0.0f, behind};
}

[[gnu::always_inline]] inline Site site_at(float x, float y, float slice, const OpacityLayout& layout,
                                           const Columns& map) {
  const auto i = static_cast<std::int32_t>(x), j = static_cast<std::int32_t>(y);
  const float last = static_cast<float>(layout.slices);
  const float depth = slice > 0.0f ? (slice < last ? slice : last) : 0.0f;
  const auto k = std::min(static_cast<std::int32_t>(depth), static_cast<std::int32_t>(layout.slices) - 1);
  return {j * map.across + i * map.row + k, k, x - static_cast<float>(i), y - static_cast<float>(j),
          depth - static_cast<float>(k)};
}

}  // namespace

Vec3 OpacityMap::texel_from_tree(const Vec3& point_m) const {
  const Vec3 p = along(layout_.axes, point_m);
  return {(p.x - layout_.corner.x) / layout_.texel_m - 0.5, (p.y - layout_.corner.y) / layout_.texel_m - 0.5,
          (layout_.lit_side_m - p.z) / layout_.slice_m};
}

void OpacityMap::add_at(const AffineFloat& a, std::span<const float> x, std::span<const float> y,
                        std::span<const float> z, std::span<float> before, std::span<float> behind) const {
  if (layout_.slices == 0) return;
  SUNFLECK_EXPECTS(cumulated_.size() < (1ull << 31));
  const Columns map{cumulated_.data(), static_cast<std::int32_t>(layout_.slices + 1),
                    static_cast<std::int32_t>(layout_.texels_across * (layout_.slices + 1))};
  const float last_x = static_cast<float>(layout_.texels_across - 1),
              last_y = static_cast<float>(layout_.texels_upwards - 1);
  std::array<std::uint32_t, kAtOnce> inside;
  std::array<float, kAtOnce> column, row, slice;
  for (std::size_t first = 0; first < x.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, x.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const float px = x[first + i], py = y[first + i], pz = z[first + i];
      column[i] = a.row[0][0] * px + a.row[0][1] * py + a.row[0][2] * pz + a.row[0][3];
      row[i] = a.row[1][0] * px + a.row[1][1] * py + a.row[1][2] * pz + a.row[1][3];
      slice[i] = a.row[2][0] * px + a.row[2][1] * py + a.row[2][2] * pz + a.row[2][3];
    }
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
      inside[found] = static_cast<std::uint32_t>(i);
      found += static_cast<std::size_t>((column[i] >= 0.0f) & (row[i] >= 0.0f) & (column[i] < last_x) &
                                        (row[i] < last_y));
    }
    for (std::size_t k = 0; k < found; ++k) {
      const std::uint32_t i = inside[k];
      const Depths d = read_site(map, site_at(column[i], row[i], slice[i], layout_, map), {});
      before[first + i] += d.before;
      behind[first + i] += d.behind;
    }
  }
}

void OpacityMap::around_all(const Prototype& prototype, const ElementRows& rows, std::size_t begin,
                            std::size_t end, std::span<float> before, std::span<float> behind) const {
  SUNFLECK_EXPECTS(rows.size() == prototype.foliage.size() && before.size() == rows.size() &&
                   behind.size() == rows.size() && cumulated_.size() < (1ull << 31));
  const Columns map{cumulated_.data(), static_cast<std::int32_t>(layout_.slices + 1),
                    static_cast<std::int32_t>(layout_.texels_across * (layout_.slices + 1))};
  const Vec3 zero = texel_from_tree(Vec3(0.0)), to_x = texel_from_tree({1, 0, 0}) - zero,
             to_y = texel_from_tree({0, 1, 0}) - zero, to_z = texel_from_tree({0, 0, 1}) - zero;
  const Vec3f light(layout_.axes.to_light);
  const float per_texel = static_cast<float>(1.0 / (layout_.texel_m * layout_.texel_m));
  const double last_x = static_cast<double>(layout_.texels_across) - 1.0,
               last_y = static_cast<double>(layout_.texels_upwards) - 1.0;
  for (std::size_t e = begin; e < end; ++e) {
    // In double: weights of the element's own shares have to be those it was laid down with.
    const Vec3 p = zero + static_cast<double>(rows.x_m[e]) * to_x + static_cast<double>(rows.y_m[e]) * to_y +
                   static_cast<double>(rows.z_m[e]) * to_z;
    const bool fits = rows.longest_m[e] < 0.999f * static_cast<float>(layout_.texel_m) && p.x >= 0.0 &&
                      p.y >= 0.0 && p.x < last_x && p.y < last_y;
    if (!fits) {
      const OpticalDepths slow = around(prototype.foliage[e]);
      before[e] = static_cast<float>(slow.before);
      behind[e] = static_cast<float>(slow.behind);
      continue;
    }
    const double i = std::floor(p.x), j = std::floor(p.y);
    Site site = site_at(static_cast<float>(i), static_cast<float>(j), static_cast<float>(p.z), layout_, map);
    site.right = static_cast<float>(p.x - i);
    site.up = static_cast<float>(p.y - j);
    const float shown =
        std::fabs(rows.normal_x[e] * light.x + rows.normal_y[e] * light.y + rows.normal_z[e] * light.z) +
        rows.needles_m2[e];
    const float cover = shown * per_texel;
    const std::array<float, 4> weight{(1.0f - site.right) * (1.0f - site.up), site.right * (1.0f - site.up),
                                      (1.0f - site.right) * site.up, site.right * site.up};
    std::array<Depths, 4> own;
    for (std::size_t q = 0; q < 4; ++q) {
      const float depth = depth_of_share(least_of(cover * weight[q], kMostCover));
      own[q] = {site.part * depth, (1.0f - site.part) * depth};
    }
    const Depths d = read_site(map, site, own);
    before[e] = d.before;
    behind[e] = d.behind;
  }
}

}  // namespace sunfleck
