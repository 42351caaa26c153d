// See sun_maps.h.
#include "lighting/slab/sun_maps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMapBytes = std::size_t{1} << 30;
constexpr std::size_t kExactYaws = 256;
constexpr int kYawSteps = 64;

std::vector<MapWish> sun_wishes(const Forest& forest, const SunYaws& yaws, const Vec3& to_sun) {
  std::vector<MapWish> wishes;
  std::set<std::pair<std::uint32_t, std::uint64_t>> seen;
  for (const Instance& i : forest.instances) {
    if (!seen.insert({i.prototype.value, yaws.key(i)}).second) continue;
    const double c = std::cos(yaws.yaw_rad(i)), s = std::sin(yaws.yaw_rad(i));
    wishes.push_back({i.prototype.value,
                      yaws.key(i),
                      {c * to_sun.x + s * to_sun.y, c * to_sun.y - s * to_sun.x, to_sun.z}});
  }
  return wishes;
}

int affordable_resolution(const Forest& forest, const std::vector<MapWish>& wishes, int resolution) {
  for (; resolution > 8; resolution /= 2) {
    // Maps are no larger than this; to know better costs a look at every leaf for each.
    if (wishes.size() * largest_opacity_map_bytes(resolution) <= kMapBytes) break;
    std::size_t bytes = 0;
    for (const MapWish& w : wishes)
      bytes += opacity_map_bytes(opacity_layout(forest.prototypes[w.prototype], w.to_light, resolution));
    if (bytes <= kMapBytes) break;
  }
  return std::max(resolution, 8);
}

constexpr std::size_t kElementsAtOnce = 65536;

std::vector<OwnDepths> own_depths(const Forest& forest, const MapTable& maps, const RunControl& control) {
  std::vector<OwnDepths> own(maps.size());
  for_each_chunk(maps.size(), 1, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      const ElementRows& rows = maps.rows(maps.prototype(m));
      own[m] = {std::vector<float>(rows.size()), std::vector<float>(rows.size())};
      for (std::size_t e = 0; e < rows.size(); e += kElementsAtOnce) {
        control.check();
        maps.map(m).around_all(forest.prototypes[maps.prototype(m)], rows, e,
                               std::min(e + kElementsAtOnce, rows.size()), own[m].before, own[m].behind);
      }
    }
  });
  return own;
}

}  // namespace

SunYaws::SunYaws(const Forest& forest) {
  if (forest.instances.empty()) return;
  base_rad_ = forest.instances.front().yaw_rad;
  std::set<std::pair<std::uint32_t, float>> different;
  for (const Instance& i : forest.instances) {
    different.insert({i.prototype.value, i.yaw_rad});
    if (different.size() > kExactYaws) break;
  }
  if (different.size() > kExactYaws) step_rad_ = 2.0 * kPi / kYawSteps;
}

double SunYaws::yaw_rad(const Instance& i) const {
  if (step_rad_ == 0.0) return i.yaw_rad;
  return base_rad_ + step_rad_ * static_cast<double>(step(i));
}

std::uint64_t SunYaws::key(const Instance& i) const {
  return step_rad_ == 0.0 ? std::bit_cast<std::uint32_t>(i.yaw_rad) : step(i);
}

std::uint64_t SunYaws::step(const Instance& i) const {
  const double turns = (i.yaw_rad - base_rad_) / (2.0 * kPi);
  return static_cast<std::uint64_t>(std::lround((turns - std::floor(turns)) * kYawSteps)) % kYawSteps;
}

SunMaps::SunMaps(const Forest& forest, const Vec3& to_sun, int map_resolution, const RunControl& control)
    : yaws_(forest) {
  const std::vector<MapWish> wishes = sun_wishes(forest, yaws_, to_sun);
  resolution_ = affordable_resolution(forest, wishes, map_resolution);
  table_.emplace(forest, wishes, resolution_, control, "sun maps");
  std::vector<Box> bounds;
  for (const Prototype& p : forest.prototypes) bounds.push_back(prototype_bounds(p));
  for (const Instance& i : forest.instances) {
    const OpacityMap& map = table_->at(i.prototype.value, yaws_.key(i));
    placed_.push_back(place_map(i, map, bounds[i.prototype.value], yaws_.yaw_rad(i), forest_origin(forest)));
    texel_m_ = std::max(texel_m_, map.layout().texel_m * i.scale);
    turn_ratio_.push_back(static_cast<float>(
        map.leaf_projection() > 0.0 ? map.mean_square_cosine() / map.leaf_projection() : 2.0 / 3.0));
  }
  neighbours_.emplace(forest, placed_, to_sun);
  own_ = own_depths(forest, *table_, control);
}

}  // namespace sunfleck
