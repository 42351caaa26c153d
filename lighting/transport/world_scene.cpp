// See world_scene.h.
#include "lighting/transport/world_scene.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr double kLargestCell = 0.5, kCellsPerCrown = 6, kFewestSidesOfWorldCell = 2;
constexpr int kGroundCellsPerSide = 256;
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

void class_directions(WorldScene& scene) {
  std::vector<std::size_t> first_of_class;
  const auto alike = [&](std::size_t a, std::size_t b) {
    const double rise = std::abs(scene.set.to_source[a].z) - std::abs(scene.set.to_source[b].z);
    return std::abs(rise) < 1e-9 && std::abs(scene.plans[a].step_m / scene.plans[b].step_m - 1.0) < 1e-9;
  };
  for (std::size_t j = 0; j < scene.set.half(); ++j) {
    std::size_t c = 0;
    while (c < first_of_class.size() && !alike(j, first_of_class[c])) ++c;
    if (c == first_of_class.size()) first_of_class.push_back(j);
    scene.optical_class.push_back(c);
  }
  scene.transmittance.assign(first_of_class.size() * scene.cells(), 1.0f);
}

void fill_transmittance(WorldScene& scene, const RunControl& control) {
  const auto per_face = static_cast<float>(1.0 / scene.face_m2());
  const std::size_t classes = scene.transmittance.size() / scene.cells();
  std::vector<std::size_t> direction(classes);
  for (std::size_t j = scene.set.half(); j-- > 0;) direction[scene.optical_class[j]] = j;
  for_each_chunk(scene.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    for (std::uint32_t c = scene.ranges[r].begin; c < scene.ranges[r].end; ++c) {
      if (scene.first_entry[c] == scene.first_entry[c + 1]) continue;
      for (std::size_t k = 0; k < classes; ++k) {
        float cover = 0.0f;
        for (std::uint32_t e = scene.first_entry[c]; e < scene.first_entry[c + 1]; ++e)
          cover += scene.entries[e].area_m2 * scene.cover[scene.entries[e].kind][direction[k]];
        scene.transmittance[k * scene.cells() + c] =
            std::exp(-0.5f * cover * per_face * scene.lanes.step_cells[direction[k]]);
      }
    }
  });
}

void find_ground_below(WorldScene& scene, const RunControl& control) {
  const int nx = scene.layout.cells[0], ny = scene.layout.cells[1];
  scene.ground_below.resize(scene.set.count());
  for_each_chunk(scene.set.count(), 1, control, {}, [&](std::size_t d, std::size_t) {
    if (!scene.frame.ends_on_ground(scene.set.to_source[d])) return;
    const Vec3 towards = scene.frame.field_direction(scene.set.to_source[d]);
    auto& below = scene.ground_below[d];
    below.reserve(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        below.push_back(
            scene.ground->hit(scene.layout.lo_m + (Vec3(x, y, -1) + 0.5) * scene.layout.cell_m, towards));
  });
}

}  // namespace

double world_cell_size(const Forest& forest) {
  std::vector<double> width, side;
  for (const Prototype& p : forest.prototypes) {
    width.push_back(2.0 * prototype_reach_m(p));
    side.push_back(prototype_leaf_side(p));
  }
  double mean_width = 0.0, mean_side = 0.0;
  for (const Instance& i : forest.instances) {
    const double share = i.scale / static_cast<double>(forest.instances.size());
    mean_width += share * width[i.prototype.value];
    mean_side += share * side[i.prototype.value];
  }
  const double cell =
      std::max(std::min(kLargestCell, mean_width / kCellsPerCrown), kFewestSidesOfWorldCell * mean_side);
  return cell > 0.0 ? cell : kLargestCell;
}

Box world_box(const Forest& forest, const GridFrame& frame) {
  std::vector<Box> of_prototype;
  for (const Prototype& p : forest.prototypes) of_prototype.push_back(prototype_bounds(p));
  Box box;
  for (const Instance& instance : forest.instances) {
    const Box& b = of_prototype[instance.prototype.value];
    if (b.empty()) continue;
    for (const double x : {b.lo.x, b.hi.x})
      for (const double y : {b.lo.y, b.hi.y})
        for (const double z : {b.lo.z, b.hi.z})
          box.include(frame.unwrapped_from_world(world_from_tree(instance, {x, y, z})));
  }
  return box;
}

std::uint64_t world_bytes_per_cell(int directions) {
  const auto n = static_cast<std::uint64_t>(directions == 14 ? 16 : directions);
  // Sky, two bands, transmittance of at most half the directions, sun, entries.
  return sizeof(float) * (3 * n + n / 2 + 3) + sizeof(WorldEntry) * 2;
}

std::vector<WorldPrototype> world_prototypes(const Forest& forest, double cell_m, const RunControl& control) {
  std::vector<double> largest(forest.prototypes.size(), 0.0);
  for (const Instance& i : forest.instances)
    largest[i.prototype.value] = std::max(largest[i.prototype.value], static_cast<double>(i.scale));
  std::vector<WorldPrototype> prototypes(forest.prototypes.size());
  for_each_chunk(prototypes.size(), 1, control, "prototypes", [&](std::size_t p, std::size_t) {
    if (largest[p] > 0.0)
      prototypes[p] = world_prototype(forest.prototypes[p], 0.5 * cell_m / largest[p], control);
  });
  return prototypes;
}

WorldScene world_scene(const Forest& forest, std::vector<WorldPrototype> prototypes, const GridLayout& layout,
                       DirectionSet set, const RunControl& control) {
  WorldScene scene;
  scene.periodic = forest.period.has_value();
  scene.set = std::move(set);
  scene.frame = grid_frame(forest);
  scene.layout = layout;
  plan_sweeps(scene);
  scene.lanes = direction_lanes(scene.set, scene.step_cells());
  scene.prototypes = std::move(prototypes);
  for (const WorldPrototype& p : scene.prototypes) {
    scene.cover.push_back(leaf_cover(p, scene.set));
    scene.cover.push_back(wood_cover(p, scene.set));
  }
  for (const Instance& i : forest.instances)
    scene.instance_leaf_m2.push_back(std::pow(static_cast<double>(i.scale), 2) *
                                     scene.prototypes[i.prototype.value].leaf_area_m2);
  collect_entries(scene, placed_entries(scene, forest, control));
  add_ranges(scene);
  class_directions(scene);
  fill_transmittance(scene, control);
  scene.ground =
      std::make_unique<GroundMap>(forest, scene.frame, scene.layout, scene.set, kGroundCellsPerSide, control);
  find_ground_below(scene, control);
  return scene;
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
