// What the light map does not know and a picture without bounces needs: the mean irradiance of ground and
// wood, and the colour of scattered light. Found once per picture from some ten thousand rays, in rounds that
// each use the last one's answer.
#pragma once

#include "sim/base/vec.h"

namespace sunfleck {

struct ShadingParts;

struct MeanLight {
  Vec3 ground_w_m2{0};   // mean over the ground below the forest's box, or the period
  Vec3 wood_w_m2{0};     // mean over points of wood, by area
  Vec3 scatter_tint{1};  // colour of light off leaves, wood and ground: in the channels over in the band
};

// `grey`: the same with all colours 1, as the light map was computed. Deterministic.
MeanLight find_mean_light(const ShadingParts& parts, const ShadingParts& grey);

}  // namespace sunfleck
