// See tree_space.h.
#include "lighting/transport/tree_space.h"

#include "lighting/depth/extinction_grid.h"
#include "lighting/transport/world_scatter.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

// Between the tree and the fine grid's border: a cell of the world, half a cell of those that are coarser
// than this for want of memory (-0.4 % of scattered sunlight).
constexpr double kUsualMargin_m = 0.5;
double margin_m(double world_cell_m) {
  return std::min(world_cell_m, std::max(0.5 * world_cell_m, kUsualMargin_m));
}

constexpr std::uint64_t kMostFineCells = 4 << 20;  // of one tree

// The forest with one instance and its prototype alone; numbers of prototypes stay.
Forest only_tree(const Forest& forest, std::size_t instance) {
  Forest tree;
  tree.materials = forest.materials;
  tree.terrain = forest.terrain;
  tree.instances = {forest.instances[instance]};
  for (const Prototype& p : forest.prototypes) {
    const bool this_one = tree.prototypes.size() == forest.instances[instance].prototype.value;
    tree.prototypes.push_back(this_one ? p : Prototype{});
    tree.prototypes.back().materials = p.materials;
  }
  return tree;
}

// A frame with its origin at the stem foot.
GridFrame tree_frame(const Forest& tree) {
  GridFrame frame;
  frame.ground_normal = tree.terrain.normal();
  frame.origin_m = tree.instances[0].position_m;
  return frame;
}

// Other trees are no finer than the world's cells: their depth is marched from the middles of those.
std::vector<float> others_sun_depth(const TreeSpace& space, const Vec3& towards, const RunControl& control) {
  std::vector<float> depth(space.around.count());
  // Small chunks: level rays go around a periodic scene many times.
  for_each_chunk(depth.size(), 16, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      depth[i] = static_cast<float>(space.around.sun_depth_of_others(space.around.centre(i), towards));
  });
  return depth;
}

}  // namespace

TreeSpace::TreeSpace(const Forest& forest, const WorldLight& world, std::size_t instance,
                     const RunControl& control)
    : scene(*world.prepared.scene),
      sources(*world.sources),
      tree(only_tree(forest, instance)),
      index(tree),
      fine(transport_scene(tree, index, scene.set,
                           {.max_cells = kMostFineCells,
                            .margin_m = margin_m(scene.layout.mean_cell_m()),
                            .frame = tree_frame(tree)},
                           control)),
      around(scene, sources, tree.instances[0], covered()),
      lookup(around, scene, fine.layout, fine.frame.origin_m) {}

Vec3 TreeSpace::fine_centre(std::uint32_t cell) const {
  const auto at = fine.layout.unflat(cell);
  return fine.layout.lo_m + (Vec3(at[0], at[1], at[2]) + 0.5) * fine.layout.cell_m;
}

Box TreeSpace::covered() const {
  const Vec3 lo = fine.layout.lo_m - fine.layout.cell_m,
             hi = fine.layout.lo_m + fine.layout.size_m() + fine.layout.cell_m;
  Box box;
  for (const double x : {lo.x, hi.x})
    for (const double y : {lo.y, hi.y})
      for (const double z : {lo.z, hi.z}) box.include(world_point({x, y, z}));
  return box;
}

Background add_others(TreeSpace& space, const RunControl& control) {
  Background others;
  const std::size_t half = space.fine.set.half(), cells = space.fine.cells();
  const double fine_m = space.fine.layout.mean_cell_m(),
               volume = std::pow(space.scene.layout.mean_cell_m(), 3);
  std::vector<Lanes> pass(space.around.count());
  others.depth.assign(space.around.count(), {});
  for (std::size_t b = 0; b < space.around.count(); ++b) {
    for (const WorldEntry& e : space.around.others()[b])
      for (std::size_t j = 0; j < half; ++j)
        others.depth[b][j] += static_cast<float>(e.area_m2 * space.scene.cover[e.kind][j] * fine_m / volume);
    for (std::size_t j = 0; j < half; ++j)
      pass[b][j] = std::exp(-0.5f * others.depth[b][j] * space.fine.lanes.step_cells[j]);
  }
  others.of_cell.resize(cells);
  for_each_chunk(cells, 8192, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const std::uint32_t b =
          space.around.block_cell(space.world_point(space.fine_centre(static_cast<std::uint32_t>(c))));
      others.of_cell[c] = b;
      if (space.around.others()[b].empty()) continue;
      for (std::size_t j = 0; j < half; ++j) space.fine.transmittance[j * cells + c] *= pass[b][j];
    }
  });
  return others;
}

void set_others_sources(const TreeSpace& space, const WorldKernels& kernels, double beam_w_m2,
                        const std::vector<float>& block, Background& others) {
  const std::size_t half = space.scene.set.half(), count = space.around.count();
  const double fine_m = space.fine.layout.mean_cell_m();
  const auto per_volume = static_cast<float>(fine_m / std::pow(space.scene.layout.mean_cell_m(), 3));
  const auto beam = static_cast<float>(beam_w_m2);
  const ScatterCell scatter_cell = scatter_cell_best();
  others.source_near.assign(count, {});
  others.source_far.assign(count, {});
  for (std::size_t i = 0; i < count; ++i) {
    if (space.around.others()[i].empty()) continue;
    BothLanes light{};
    alignas(64) BothLanes source{};
    for (std::size_t j = 0; j < half; ++j) {
      light[j] = block[j * count + i];
      light[kLanes + j] = block[(half + j) * count + i];
    }
    const float sun = space.sources.sun_transmittance.empty()
                          ? 0.0f
                          : beam * space.sources.sun_transmittance[*space.around.cells()[i]];
    scatter_cell(space.around.others()[i], kernels.kinds.data(), light, sun, source);
    for (std::size_t j = 0; j < half; ++j) {
      others.source_near[i][j] = per_volume * source[j];
      others.source_far[i][j] = per_volume * source[kLanes + j];
    }
  }
}

DirectSun tree_sun(const TreeSpace& space, const Vec3& to_sun, const RunControl& control) {
  DirectSun sun;
  const Vec3 towards = space.scene.frame.field_direction(to_sun);
  const ExtinctionGrid own(*space.fine.field, to_sun, control);
  std::vector<float> depths = own.depth_of_elements(March::kForward, control);
  const auto& elements = space.fine.field->elements();
  const std::vector<float> others = others_sun_depth(space, towards, control);
  for_each_chunk(depths.size(), 4096, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      depths[i] = std::min(
          static_cast<float>(kLargestDepth),
          depths[i] + space.around.between(others.data(), space.world_point(Vec3(elements[i].centre_m))));
  });
  light_elements(sun, *space.fine.field, depths, to_sun, control);
  const auto& wood = space.fine.contents.wood;
  sun.wood = wood_depths(space.fine.contents, *space.fine.field, to_sun);
  for_each_chunk(wood.size(), 16, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const Vec3 centre = space.fine_centre(wood[w].cell);
      const double depth = own.depth_from_point(centre + space.fine.frame.origin_m, March::kForward) +
                           space.around.between(others.data(), space.world_point(centre));
      sun.wood[w] *= static_cast<float>(std::exp(-depth));
    }
  });
  return sun;
}

}  // namespace sunfleck::transport
