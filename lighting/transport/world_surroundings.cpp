// See world_surroundings.h.
#include "lighting/transport/world_surroundings.h"

#include "lighting/depth/grid_march.h"
#include "lighting/transport/world_contents.h"

namespace sunfleck::transport {

namespace {

// Areas smaller than this share of what the tree itself has in a cell are rounding.
constexpr float kRounding = 1e-4f;

std::vector<WorldEntry> without(const WorldScene& scene, std::uint32_t cell, std::uint32_t kind,
                                float leaf_m2, float wood_m2) {
  std::vector<WorldEntry> rest;
  for (std::uint32_t e = scene.first_entry[cell]; e < scene.first_entry[cell + 1]; ++e) {
    WorldEntry entry = scene.entries[e];
    const float own = entry.kind == kind ? leaf_m2 : entry.kind == kind + 1 ? wood_m2 : 0.0f;
    entry.area_m2 -= own;
    if (entry.area_m2 > kRounding * own) rest.push_back(entry);
  }
  return rest;
}

}  // namespace

Surroundings::Surroundings(const WorldScene& scene, const WorldSources& sources, const Instance& instance,
                           const Box& covered)
    : scene_(scene), sources_(sources) {
  const GridLayout& layout = scene.layout;
  std::size_t count = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    const auto index = [&](double at) {
      return static_cast<int>(std::floor((at - layout.lo_m[axis]) / layout.cell_m[axis]));
    };
    lo_[a] = index(covered.lo[axis]) - 1;
    size_[a] = index(covered.hi[axis]) + 2 - lo_[a];
    count *= static_cast<std::size_t>(size_[a]);
  }
  const InstanceContent own = instance_content(scene, instance);
  const std::uint32_t kind = leaf_kind(instance.prototype.value);
  cells_.resize(count);
  others_.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    const std::array<int, 3> at = place(b);
    cells_[b] = grid_cell(layout, at);
    const bool holds = own.holds(at);
    if (cells_[b])
      others_[b] = without(scene, *cells_[b], kind, holds ? own.leaf_m2[own.at(at)] : 0.0f,
                           holds ? own.wood_m2[own.at(at)] : 0.0f);
  }
  if (sources.sun_extinction_per_m.empty()) return;
  own_layout_ = layout;
  own_layout_.wraps_xy = false;
  own_layout_.cells = own.size;
  own_layout_.lo_m += Vec3(own.lo[0], own.lo[1], own.lo[2]) * layout.cell_m;
  const double volume = std::pow(layout.mean_cell_m(), 3);
  own_sun_extinction_per_m_.resize(own.leaf_m2.size());
  for (std::size_t i = 0; i < own.leaf_m2.size(); ++i)
    own_sun_extinction_per_m_[i] = static_cast<float>(
        (own.leaf_m2[i] * sources.sun_cover[kind] + own.wood_m2[i] * sources.sun_cover[kind + 1]) / volume);
}

std::array<int, 3> Surroundings::place(std::size_t b) const {
  const auto nx = static_cast<std::size_t>(size_[0]), ny = static_cast<std::size_t>(size_[1]);
  return {lo_[0] + static_cast<int>(b % nx), lo_[1] + static_cast<int>(b / nx % ny),
          lo_[2] + static_cast<int>(b / nx / ny)};
}

Vec3 Surroundings::centre(std::size_t b) const {
  const std::array<int, 3> at = place(b);
  return scene_.layout.lo_m + (Vec3(at[0], at[1], at[2]) + 0.5) * scene_.layout.cell_m;
}

std::uint32_t Surroundings::block_cell(const Vec3& point_m) const {
  std::size_t index = 0;
  for (std::size_t a = 3; a-- > 0;) {
    const auto axis = static_cast<int>(a);
    const double at = std::floor((point_m[axis] - scene_.layout.lo_m[axis]) / scene_.layout.cell_m[axis]);
    index = index * static_cast<std::size_t>(size_[a]) +
            static_cast<std::size_t>(std::clamp(static_cast<int>(at) - lo_[a], 0, size_[a] - 1));
  }
  return static_cast<std::uint32_t>(index);
}

double Surroundings::sun_depth_of_others(const Vec3& point_m, const Vec3& towards) const {
  const double all = march_grid(scene_.layout, sources_.sun_extinction_per_m, point_m, towards);
  const double own = own_sun_extinction_per_m_.empty()
                         ? 0.0
                         : march_grid(own_layout_, own_sun_extinction_per_m_, point_m, towards);
  return std::max(0.0, all - own);
}

float Surroundings::between(const float* field, const Vec3& point_m) const {
  std::array<std::size_t, 3> low{};
  std::array<float, 3> part{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    const double at = (point_m[axis] - scene_.layout.lo_m[axis]) / scene_.layout.cell_m[axis] - 0.5 - lo_[a];
    const double floor = std::clamp(std::floor(at), 0.0, static_cast<double>(size_[a] - 2));
    low[a] = static_cast<std::size_t>(floor);
    part[a] = static_cast<float>(std::clamp(at - floor, 0.0, 1.0));
  }
  const auto nx = static_cast<std::size_t>(size_[0]), nxy = nx * static_cast<std::size_t>(size_[1]);
  const float* f = field + low[2] * nxy + low[1] * nx + low[0];
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const auto row = [&](const float* r) { return mix(r[0], r[1], part[0]); };
  const auto plane = [&](const float* p) { return mix(row(p), row(p + nx), part[1]); };
  return mix(plane(f), plane(f + nxy), part[2]);
}

BlockLookup::BlockLookup(const Surroundings& around, const WorldScene& scene, const GridLayout& fine,
                         const Vec3& origin_m)
    : row_(static_cast<std::size_t>(around.size()[0])),
      plane_(row_ * static_cast<std::size_t>(around.size()[1])),
      highest_(static_cast<float>(around.size()[2] - 2)),
      x_(along(0, around, scene, fine, origin_m, 1)),
      y_(along(1, around, scene, fine, origin_m, row_)) {
  const double base = fine.lo_m.z + origin_m.z - scene.frame.origin_m.z - scene.layout.lo_m.z;
  for (int k = -1; k <= fine.cells[2]; ++k)
    height_.push_back(static_cast<float>((base + (k + 0.5) * fine.cell_m.z) / scene.layout.cell_m.z - 0.5 -
                                         around.lo()[2]));
}

std::vector<BlockLookup::Part> BlockLookup::along(int axis, const Surroundings& around,
                                                  const WorldScene& scene, const GridLayout& fine,
                                                  const Vec3& origin_m, std::size_t stride) const {
  const auto a = static_cast<std::size_t>(axis);
  std::vector<Part> parts;
  for (int i = -1; i <= fine.cells[a]; ++i) {
    const double p =
        fine.lo_m[axis] + (i + 0.5) * fine.cell_m[axis] + origin_m[axis] - scene.frame.origin_m[axis];
    const double at = (p - scene.layout.lo_m[axis]) / scene.layout.cell_m[axis] - 0.5 - around.lo()[a];
    const double low = std::clamp(std::floor(at), 0.0, static_cast<double>(around.size()[a] - 2));
    parts.push_back({static_cast<std::size_t>(low) * stride,
                     static_cast<float>(std::clamp(at - low, 0.0, 1.0)),
                     static_cast<float>(scene.frame.shear[axis] * p / scene.layout.cell_m.z)});
  }
  return parts;
}

std::vector<float> block_radiance(const WorldScene& scene, const Surroundings& around,
                                  const std::vector<float>& radiance,
                                  const std::vector<WorldInflow>& outside) {
  std::vector<float> block(scene.set.count() * around.count());
  for (std::size_t d = 0; d < scene.set.count(); ++d)
    for (std::size_t b = 0; b < around.count(); ++b)
      block[d * around.count() + b] = around.cells()[b] ? radiance[d * scene.cells() + *around.cells()[b]]
                                                        : outside[d].radiance(around.place(b));
  return block;
}

}  // namespace sunfleck::transport
