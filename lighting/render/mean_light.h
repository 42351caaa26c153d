// What the light map does not know and a picture without bounces needs: the mean irradiance of ground and
// wood, and the colour of scattered light. Found once per picture from some ten thousand rays, in rounds that
// each use the last one's answer.
#pragma once

#include "sim/base/vec.h"

namespace sunfleck {

struct NearTrees;
struct ShadingParts;

struct MeanLight {
  Vec3 ground_w_m2{0};   // mean over the ground below the box of the near trees, or the period
  Vec3 wood_w_m2{0};     // mean over points of wood of the near trees, by area
  Vec3 scatter_tint{1};  // colour of light off leaves, wood and ground: in the channels over in the band
};

// `grey`: the same with all colours 1, as the light map was computed. `near`: the trees asked (seen_trees.h);
// open light where there are none. Deterministic.
MeanLight find_mean_light(const ShadingParts& parts, const ShadingParts& grey, const NearTrees& near);

}  // namespace sunfleck
