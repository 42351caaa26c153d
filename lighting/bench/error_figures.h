// How far an estimate of the light is from the truth, in the figures of the field.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/base/light_map.h"
#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// All relative to the mean of the truth; quantity: front + back irradiance of an element. The truth's own
// noise is taken out of the squares where it is known per element.
struct ErrorFigures {
  double bias = 0;         // (mean - true mean) / true mean
  double element_rms = 0;  // per element
  double cell_rms = 0;     // of the means in 3^3 cells of the scene's box, cells weighted by their elements
  double class_rms = 0;    // of the means in classes of depth and thickness towards the sun, [SPP] Eq. 30
  double diffuse_rms = 0;  // per element, sky + scattered light, relative to their own mean; noise included
};

// Which cell and which class every element is in: depends on the scene and the sun only.
struct ErrorGroups {
  std::vector<std::uint32_t> cell, depth_class;
};

// Classes: whole numbers of leaf layers before the element, and in all, along the sun's direction.
ErrorGroups error_groups(const Forest& forest, const Vec3& to_sun, const RunControl& control);

ErrorFigures compare(const ErrorGroups& groups, const BandLightMap& estimate, const BandLightMap& truth);

}  // namespace sunfleck
