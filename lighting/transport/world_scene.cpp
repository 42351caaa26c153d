// See world_scene.h.
#include "lighting/transport/world_scene.h"

#include <algorithm>
#include <cmath>

#include "lighting/transport/world_contents.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr double kLargestCell = 0.5, kCellsPerCrown = 6, kFewestSidesOfWorldCell = 2;
constexpr int kGroundCellsPerSide = 256;

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
  fill_contents(scene, forest, control);
  class_directions(scene);
  fill_transmittance(scene, control);
  scene.ground =
      std::make_unique<GroundMap>(forest, scene.frame, scene.layout, scene.set, kGroundCellsPerSide, control);
  find_ground_below(scene, control);
  return scene;
}

}  // namespace sunfleck::transport
