// Light of the sky in every cell ([SPP] Fig. 9, step 4): each upward sample direction is a source of its own.
#pragma once

#include <algorithm>
#include <vector>

#include "lighting/sky/illumination.h"
#include "lighting/slab/canopy_medium.h"
#include "lighting/slab/cell_depths.h"

namespace sunfleck {

// Normal irradiance of each axis for a diffuse horizontal irradiance of 1: solid angle times relative
// radiance, scaled so that an open horizontal plane gets exactly 1. 0 for directions below the horizon of the
// slope.
std::vector<double> sky_sources(const SampleDirections& directions, SkyModel sky, const Vec3& ground_normal);

// Scattered light in a cell for a diffuse horizontal irradiance of 1. A face with normal n gets
// sum / 4 + dot(n, drift) / 4, the two faces together sum / 2.
struct ScatteredLight {
  float sum = 0;
  Vec3f drift{0};  // points to where more light comes from

  float on_face(const Vec3& normal) const {
    return std::max(0.0f, 0.25f * (sum + static_cast<float>(glm::dot(normal, Vec3(drift)))));
  }
};

// Fluences of the two hemispheres of a source, uniform radiance in each, as scattered light.
inline void add_hemispheres(ScatteredLight& light, const Vec3& to_source, double down, double up) {
  light.sum += static_cast<float>(down + up);
  light.drift += Vec3f((down - up) * to_source);
}

// G of every cell for each axis, [cell][axis]; [SPP] Eq. 27.
std::vector<float> sky_compensation(const CellDepths& cells, const RunControl& control);

// [cell], for one band: `optics` by prototype; `compensation` as above or empty for 1 everywhere (plain SPP).
std::vector<ScatteredLight> scattered_sky_light(const Forest& forest, const ForestGrids& grids,
                                                const CellDepths& cells,
                                                const std::vector<CanopyOptics>& optics, double ground_albedo,
                                                const std::vector<double>& sources,
                                                const std::vector<float>& compensation,
                                                const RunControl& control);

}  // namespace sunfleck
