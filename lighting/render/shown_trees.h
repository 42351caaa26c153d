// The trees that a picture shows in place of those it was given: each prototype at each level of detail that
// is asked for, and which of them stands where for each cast of samples. The one place that turns a Detail
// into leaves and wood.
//
// A pruned tree shows flat leaves (no outline, no textures: both are below a pixel there and have mean 1) and
// no twigs thinner than a quarter of its enlarged leaves.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/render/picture_detail.h"

namespace sunfleck {

struct ShownTrees {
  Forest forest;                                // its instances' prototypes are those of cast 0
  std::vector<std::vector<PrototypeId>> casts;  // [cast][instance]; none: one cast, of the instances' own
  std::vector<std::vector<std::uint32_t>> originals;  // per prototype shown; empty: the same elements
  std::vector<PrototypeId> original_prototype;        // per prototype shown
  std::vector<Detail> detail;                         // per prototype shown
};

// A copy, for who changes leaves.
ShownTrees same_trees(const Forest& forest);

// Only prototypes that stand somewhere are made. Sizes of `details` match; at least one cast.
ShownTrees show_trees(const Forest& forest, const TreeDetails& details, const RunControl& control);

}  // namespace sunfleck
