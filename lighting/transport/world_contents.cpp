// See world_contents.h.
#include "lighting/transport/world_contents.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr std::size_t kEntriesPerRange = 4096, kCellsPerRange = 16384, kInstancesPerChunk = 16;

struct PlacedEntry {
  std::uint32_t cell, kind;
  float area_m2;
};

std::vector<PlacedEntry> placed_entries(const WorldScene& scene, const Forest& forest,
                                        const RunControl& control) {
  const std::size_t chunks = (forest.instances.size() + kInstancesPerChunk - 1) / kInstancesPerChunk;
  std::vector<std::vector<PlacedEntry>> parts(chunks);
  for_each_chunk(forest.instances.size(), kInstancesPerChunk, control, "world grid",
                 [&](std::size_t begin, std::size_t end) {
                   auto& part = parts[begin / kInstancesPerChunk];
                   for (std::size_t i = begin; i < end; ++i) {
                     const Instance& instance = forest.instances[i];
                     const InstanceContent content = instance_content(scene, instance);
                     std::size_t at = 0;
                     for (int z = 0; z < content.size[2]; ++z)
                       for (int y = 0; y < content.size[1]; ++y)
                         for (int x = 0; x < content.size[0]; ++x, ++at) {
                           if (!(content.leaf_m2[at] + content.wood_m2[at] > 0.0f)) continue;
                           const auto cell = grid_cell(
                               scene.layout, {content.lo[0] + x, content.lo[1] + y, content.lo[2] + z});
                           SUNFLECK_ENSURES(cell.has_value());
                           const std::size_t p = instance.prototype.value;
                           if (content.leaf_m2[at] > 0.0f)
                             part.push_back({*cell, leaf_kind(p), content.leaf_m2[at]});
                           if (content.wood_m2[at] > 0.0f)
                             part.push_back({*cell, wood_kind(p), content.wood_m2[at]});
                         }
                   }
                 });
  std::vector<PlacedEntry> all;
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  all.reserve(count);
  for (auto& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    part = {};
  }
  return all;
}

// Sorted by cell, one entry per kind.
void collect_entries(WorldScene& scene, const std::vector<PlacedEntry>& placed) {
  const std::size_t cells = scene.cells();
  std::vector<std::uint32_t> first(cells + 1, 0);
  for (const PlacedEntry& e : placed) ++first[e.cell + 1];
  for (std::size_t c = 0; c < cells; ++c) first[c + 1] += first[c];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<WorldEntry> sorted(placed.size());
  for (const PlacedEntry& e : placed) sorted[next[e.cell]++] = {e.kind, e.area_m2};
  scene.first_entry.assign(cells + 1, 0);
  std::size_t kept = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const std::size_t begin = kept;
    for (std::uint32_t i = first[c]; i < first[c + 1]; ++i) {
      std::size_t same = begin;
      while (same < kept && sorted[same].kind != sorted[i].kind) ++same;
      if (same < kept)
        sorted[same].area_m2 += sorted[i].area_m2;
      else
        sorted[kept++] = sorted[i];
    }
    scene.first_entry[c + 1] = static_cast<std::uint32_t>(kept);
  }
  sorted.resize(kept);
  scene.entries = std::move(sorted);
}

void add_ranges(WorldScene& scene) {
  const auto cells = static_cast<std::uint32_t>(scene.cells());
  for (std::uint32_t begin = 0, end; begin < cells; begin = end) {
    end = begin + 1;
    while (end < cells && end - begin < kCellsPerRange &&
           scene.first_entry[end + 1] - scene.first_entry[begin] < kEntriesPerRange)
      ++end;
    scene.ranges.push_back({begin, end});
  }
}

}  // namespace

void fill_contents(WorldScene& scene, const Forest& forest, const RunControl& control) {
  collect_entries(scene, placed_entries(scene, forest, control));
  add_ranges(scene);
}

InstanceContent instance_content(const WorldScene& scene, const Instance& instance) {
  const WorldPrototype& prototype = scene.prototypes[instance.prototype.value];
  const GridLayout& layout = scene.layout;
  const float area_scale = instance.scale * instance.scale;
  InstanceContent content;
  if (prototype.cells.empty()) return content;
  const Vec3 foot = scene.frame.unwrapped_from_world(instance.position_m);
  const double scale = instance.scale, yaw = instance.yaw_rad, cosine = std::cos(yaw), sine = std::sin(yaw);
  std::vector<std::array<int, 3>> place(prototype.cells.size());
  std::array<int, 3> hi{};
  for (std::size_t i = 0; i < place.size(); ++i) {
    const Vec3 c = scale * Vec3(prototype.cells[i].centre_m);
    const Vec2 step(cosine * c.x - sine * c.y, sine * c.x + cosine * c.y);
    const Vec3 p = foot + Vec3(step, c.z - glm::dot(scene.frame.shear, step));
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      int cell = static_cast<int>(std::floor((p[axis] - layout.lo_m[axis]) / layout.cell_m[axis]));
      if (a == 2 || !layout.wraps_xy) cell = std::clamp(cell, 0, layout.cells[a] - 1);
      place[i][a] = cell;
      content.lo[a] = i == 0 ? cell : std::min(content.lo[a], cell);
      hi[a] = i == 0 ? cell : std::max(hi[a], cell);
    }
  }
  for (std::size_t a = 0; a < 3; ++a) content.size[a] = hi[a] - content.lo[a] + 1;
  const auto count = static_cast<std::size_t>(content.size[0]) * static_cast<std::size_t>(content.size[1]) *
                     static_cast<std::size_t>(content.size[2]);
  content.leaf_m2.assign(count, 0.0f);
  content.wood_m2.assign(count, 0.0f);
  for (std::size_t i = 0; i < place.size(); ++i) {
    const std::size_t at = content.at(place[i]);
    content.leaf_m2[at] += area_scale * prototype.cells[i].leaf_m2;
    content.wood_m2[at] += area_scale * prototype.cells[i].wood_m2;
  }
  return content;
}

std::optional<std::uint32_t> grid_cell(const GridLayout& layout, std::array<int, 3> cell) {
  for (std::size_t a = 0; a < 3; ++a) {
    const int n = layout.cells[a];
    if (a < 2 && layout.wraps_xy)
      cell[a] = (cell[a] % n + n) % n;
    else if (cell[a] < 0 || cell[a] >= n)
      return std::nullopt;
  }
  return layout.flat(cell);
}

}  // namespace sunfleck::transport
