// One tree of the world in a fine grid of its own, and what the world around it is to that grid: the medium
// of other trees, the light they give back and their shade. See world_light.h.
#pragma once

#include "lighting/transport/direct_sun.h"
#include "lighting/transport/world_light.h"
#include "lighting/transport/world_surroundings.h"

namespace sunfleck::transport {

struct TreeSpace {
  // The world's scene and sources must outlive it.
  TreeSpace(const Forest& forest, const WorldLight& world, std::size_t instance, const RunControl& control);

  // Of a point in the frame of the fine grid: in the frame of the world grid.
  Vec3 world_point(const Vec3& fine_m) const {
    return scene.frame.unwrapped_from_world(fine_m + fine.frame.origin_m);
  }
  Vec3 fine_centre(std::uint32_t cell) const;

  const WorldScene& scene;
  const WorldSources& sources;
  const Forest tree;  // one instance; numbers of prototypes as in the forest
  const ForestIndex index;
  TransportScene fine;  // without ground; other trees are in its transmittance once they are added
  const Surroundings around;
  const BlockLookup lookup;

 private:
  Box covered() const;
};

// Adds the medium of other trees to the transmittance of the fine grid; the kinds are the cells of
// `space.around`, without sources.
Background add_others(TreeSpace& space, const RunControl& control);

// What other trees give back in the light of a band; `block`: radiance around the tree, as block_radiance()
// has it.
void set_others_sources(const TreeSpace& space, const WorldKernels& kernels, double beam_w_m2,
                        const std::vector<float>& block, Background& others);

// Direct sun on the tree's leaves and wood: its own shade leaf by leaf, that of others as the world's cells.
DirectSun tree_sun(const TreeSpace& space, const Vec3& to_sun, const RunControl& control);

}  // namespace sunfleck::transport
