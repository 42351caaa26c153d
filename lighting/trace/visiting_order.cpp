#include "lighting/trace/visiting_order.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunfleck::trace {
namespace {

// Puts two zero bits between the lowest ten bits.
std::uint32_t spread(std::uint32_t x) {
  x &= 0x3FFu;
  x = (x | (x << 16)) & 0x030000FFu;
  x = (x | (x << 8)) & 0x0300F00Fu;
  x = (x | (x << 4)) & 0x030C30C3u;
  return (x | (x << 2)) & 0x09249249u;
}

struct Morton {
  Vec3 lo, per_m;
  std::uint32_t operator()(const Vec3& p) const {
    const Vec3 cell = glm::clamp((p - lo) * per_m, Vec3(0.0), Vec3(1023.0));
    return spread(static_cast<std::uint32_t>(cell.x)) | (spread(static_cast<std::uint32_t>(cell.y)) << 1) |
           (spread(static_cast<std::uint32_t>(cell.z)) << 2);
  }
};

}  // namespace

std::vector<std::uint32_t> visiting_order(const Receivers& receivers) {
  const Forest& forest = receivers.forest();
  const Box box = forest_bounds(forest);
  const Vec3 size = glm::max(box.size(), Vec3(1e-12));
  const Morton code{box.lo, 1024.0 / size};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> keyed;
  keyed.reserve(receivers.foliage_count());
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& instance = forest.instances[i];
    const auto& foliage = forest.prototypes[instance.prototype.value].foliage;
    const auto first = static_cast<std::uint32_t>(receivers.index().first_element(i));
    const double c = std::cos(static_cast<double>(instance.yaw_rad)),
                 s = std::sin(static_cast<double>(instance.yaw_rad));
    for (std::uint32_t k = 0; k < foliage.size(); ++k) {
      const Vec3 p = static_cast<double>(instance.scale) * Vec3(foliage[k].centre_m);
      keyed.emplace_back(code(instance.position_m + Vec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z)),
                         first + k);
    }
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order;
  order.reserve(receivers.surface_count());
  for (const auto& [morton, surface] : keyed) order.push_back(surface);
  // Wood and ground follow as they are: neighbours in number are neighbours in space.
  for (std::size_t s = receivers.foliage_count(); s < receivers.surface_count(); ++s)
    order.push_back(static_cast<std::uint32_t>(s));
  return order;
}

}  // namespace sunfleck::trace
