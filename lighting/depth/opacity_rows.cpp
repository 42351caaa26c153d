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

// A map's texel and slice coordinates of points in the tree's frame, in double.
struct TexelFrame {
  Vec3 zero, to_x, to_y, to_z;

  explicit TexelFrame(const OpacityMap& map)
      : zero(map.texel_from_tree(Vec3(0.0))),
        to_x(map.texel_from_tree({1, 0, 0}) - zero),
        to_y(map.texel_from_tree({0, 1, 0}) - zero),
        to_z(map.texel_from_tree({0, 0, 1}) - zero) {}
  [[gnu::always_inline]] Vec3 at(const ElementRows& rows, std::size_t e) const {
    return zero + static_cast<double>(rows.x_m[e]) * to_x + static_cast<double>(rows.y_m[e]) * to_y +
           static_cast<double>(rows.z_m[e]) * to_z;
  }
};

[[gnu::always_inline]] inline float shown_m2(const ElementRows& rows, std::size_t e, const Vec3f& light) {
  return std::fabs(rows.normal_x[e] * light.x + rows.normal_y[e] * light.y + rows.normal_z[e] * light.z) +
         rows.needles_m2[e];
}

// In one piece and inside the map: its site. Coordinates are in double, so that what an element adds and what
// is left out of it later have the same weights.
[[gnu::always_inline]] inline bool whole_site(const OpacityLayout& layout, const Columns& map, const Vec3& p,
                                              float longest_m, Site& site) {
  if (!(longest_m < 0.999f * static_cast<float>(layout.texel_m) && p.x >= 0.0 && p.y >= 0.0 &&
        p.x < static_cast<double>(layout.texels_across - 1) &&
        p.y < static_cast<double>(layout.texels_upwards - 1)))
    return false;
  const auto i = static_cast<std::int32_t>(p.x), j = static_cast<std::int32_t>(p.y);
  site = site_at(static_cast<float>(i), static_cast<float>(j), static_cast<float>(p.z), layout, map);
  site.right = static_cast<float>(p.x - i);
  site.up = static_cast<float>(p.y - j);
  return true;
}

[[gnu::always_inline]] inline std::array<float, 4> own_depths(const Site& s, float cover) {
  return {depth_of_share(least_of(cover * ((1.0f - s.right) * (1.0f - s.up)), kMostCover)),
          depth_of_share(least_of(cover * (s.right * (1.0f - s.up)), kMostCover)),
          depth_of_share(least_of(cover * ((1.0f - s.right) * s.up), kMostCover)),
          depth_of_share(least_of(cover * (s.right * s.up), kMostCover))};
}

// Sites to be read together, and what to leave out at each.
struct Sites {
  alignas(64) std::array<std::int32_t, kAtOnce> at, slice;
  alignas(64) std::array<float, kAtOnce> right, up, part;
  alignas(64) std::array<std::array<float, kAtOnce>, 4> own;  // depth, of which `part` lies above the site
  alignas(64) std::array<float, kAtOnce> before, behind;      // the answers

  void set(std::size_t i, const Site& s) {
    at[i] = s.at;
    slice[i] = s.slice;
    right[i] = s.right;
    up[i] = s.up;
    part[i] = s.part;
  }
};

template <bool kOwn>
[[gnu::always_inline]] inline void read_loop(const Columns& map, std::size_t count, Sites& sites) {
  for (std::size_t i = 0; i < count; ++i) {
    const Site s{sites.at[i], sites.slice[i], sites.right[i], sites.up[i], sites.part[i]};
    std::array<Depths, 4> own{};
    if (kOwn)
      for (std::size_t q = 0; q < 4; ++q)
        own[q] = {s.part * sites.own[q][i], (1.0f - s.part) * sites.own[q][i]};
    const Depths d = read_site(map, s, own);
    sites.before[i] = d.before;
    sites.behind[i] = d.behind;
  }
}

#define SUNFLECK_AVX512 [[gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]]
SUNFLECK_AVX512 void read_avx512(const Columns& map, std::size_t count, Sites& sites) {
  read_loop<false>(map, count, sites);
}
SUNFLECK_AVX512 void read_others_avx512(const Columns& map, std::size_t count, Sites& sites) {
  read_loop<true>(map, count, sites);
}
void read_v3(const Columns& map, std::size_t count, Sites& sites) { read_loop<false>(map, count, sites); }
void read_others_v3(const Columns& map, std::size_t count, Sites& sites) {
  read_loop<true>(map, count, sites);
}

using ReadSites = void (*)(const Columns& map, std::size_t count, Sites& sites);
bool is_wide_machine() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
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
  const ReadSites read_sites = is_wide_machine() ? read_avx512 : read_v3;
  Sites sites;
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
    for (std::size_t k = 0; k < found; ++k)
      sites.set(k, site_at(column[inside[k]], row[inside[k]], slice[inside[k]], layout_, map));
    read_sites(map, found, sites);
    for (std::size_t k = 0; k < found; ++k) {
      before[first + inside[k]] += sites.before[k];
      behind[first + inside[k]] += sites.behind[k];
    }
  }
}

void OpacityMap::around_all(const Prototype& prototype, const ElementRows& rows, std::size_t begin,
                            std::size_t end, std::span<float> before, std::span<float> behind) const {
  SUNFLECK_EXPECTS(rows.size() == prototype.foliage.size() && before.size() == rows.size() &&
                   behind.size() == rows.size() && cumulated_.size() < (1ull << 31));
  const Columns map{cumulated_.data(), static_cast<std::int32_t>(layout_.slices + 1),
                    static_cast<std::int32_t>(layout_.texels_across * (layout_.slices + 1))};
  const TexelFrame frame(*this);
  const Vec3f light(layout_.axes.to_light);
  const float per_texel = static_cast<float>(1.0 / (layout_.texel_m * layout_.texel_m));
  const ReadSites read_sites = is_wide_machine() ? read_others_avx512 : read_others_v3;
  Sites sites;
  std::array<std::size_t, kAtOnce> element;
  for (std::size_t first = begin; first < end; first += kAtOnce) {
    std::size_t found = 0;
    for (std::size_t e = first; e < std::min(end, first + kAtOnce); ++e) {
      Site site;
      if (!whole_site(layout_, map, frame.at(rows, e), rows.longest_m[e], site)) {
        const OpticalDepths slow = around(prototype.foliage[e]);
        before[e] = static_cast<float>(slow.before);
        behind[e] = static_cast<float>(slow.behind);
        continue;
      }
      const std::array<float, 4> depth = own_depths(site, shown_m2(rows, e, light) * per_texel);
      sites.set(found, site);
      for (std::size_t q = 0; q < 4; ++q) sites.own[q][found] = depth[q];
      element[found++] = e;
    }
    read_sites(map, found, sites);
    for (std::size_t k = 0; k < found; ++k) {
      before[element[k]] = sites.before[k];
      behind[element[k]] = sites.behind[k];
    }
  }
}

void OpacityMap::add_rows(const Prototype& prototype, const ElementRows& rows, const RunControl& control) {
  if (layout_.slices == 0) return;
  SUNFLECK_EXPECTS(rows.size() == prototype.foliage.size() && cumulated_.size() < (1ull << 31));
  const Columns map{cumulated_.data(), static_cast<std::int32_t>(layout_.slices + 1),
                    static_cast<std::int32_t>(layout_.texels_across * (layout_.slices + 1))};
  const TexelFrame frame(*this);
  const Vec3f light(layout_.axes.to_light);
  const float per_texel = static_cast<float>(1.0 / (layout_.texel_m * layout_.texel_m));
  for (std::size_t e = 0; e < rows.size(); ++e) {
    if (e % 16384 == 0) control.check();
    Site site;
    if (!whole_site(layout_, map, frame.at(rows, e), rows.longest_m[e], site)) {
      add_element(prototype.foliage[e]);
      continue;
    }
    const std::array<float, 4> depth = own_depths(site, shown_m2(rows, e, light) * per_texel);
    float* first = cumulated_.data() + site.at + 1;
    first[0] += depth[0];
    first[map.row] += depth[1];
    first[map.across] += depth[2];
    first[map.across + map.row] += depth[3];
  }
}

void OpacityMap::measure_angles(const Prototype& prototype, const ElementRows& rows) {
  const Vec3f light(layout_.axes.to_light);
  double area = 0.0, projected = 0.0, squared = 0.0;
  for (std::size_t e = 0; e < rows.size(); ++e) {
    const float own = prototype.foliage[e].area_m2;
    if (!(own > 0.0f)) continue;
    const float shown = shown_m2(rows, e, light);
    area += own;
    projected += shown;
    squared += rows.needles_m2[e] > 0.0f ? own / 3.0f : shown * shown / own;
  }
  if (!(area > 0.0)) return;  // keep the values of randomly turned leaves
  leaf_projection_ = projected / area;
  mean_square_cosine_ = squared / area;
}

}  // namespace sunfleck
