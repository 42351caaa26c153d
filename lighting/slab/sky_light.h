// Light of the sky in every cell ([SPP] Fig. 9, step 4): each upward sample direction is a source of its own.
//
// What every source of strength 1 leaves in every cell depends on the depths and on the leaves' optics, not
// on the sky: the closed form is evaluated once per band (SkyResponse), and a change of sky is a weighted sum
// of what is there.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "lighting/sky/illumination.h"
#include "lighting/slab/canopy_angles.h"
#include "lighting/slab/canopy_medium.h"
#include "lighting/slab/cell_depths.h"

namespace sunfleck {

// Normal irradiance of each axis for a diffuse horizontal irradiance of 1: solid angle times relative
// radiance, scaled so that an open horizontal plane gets exactly 1. 0 for directions below the horizon of the
// slope.
std::vector<double> sky_sources(const SampleDirections& directions, const SkyRadiance& sky,
                                const Vec3& ground_normal);

// Scattered light in a cell for a diffuse horizontal irradiance of 1. A face with normal n gets
// sum / 4 + dot(n, drift) / 4, the two faces together sum / 2.
struct ScatteredLight {
  float sum = 0;
  Vec3f drift{0};  // points to where more light comes from

  float on_face(const Vec3& normal) const {
    return std::max(0.0f, 0.25f * (sum + static_cast<float>(glm::dot(normal, Vec3(drift)))));
  }
};

// Fluences of the two hemispheres around an axis, uniform radiance in each, as scattered light.
inline ScatteredLight of_hemispheres(const Vec3& axis, double down, double up) {
  return {static_cast<float>(down + up), Vec3f((down - up) * axis)};
}

// The same for all cells, one array per number.
struct ScatteredCells {
  std::vector<float> sum, drift_x, drift_y, drift_z;

  bool empty() const { return sum.empty(); }
  ScatteredLight at(std::size_t cell) const {
    return {sum[cell], {drift_x[cell], drift_y[cell], drift_z[cell]}};
  }
};

// G of every cell for each axis, [axis][cell]; [SPP] Eq. 27.
std::vector<float> sky_compensation(const CellDepths& cells, const RunControl& control);

// Fluence of the two hemispheres for each source of strength 1 in one band.
struct SkyResponse {
  std::size_t cells = 0;
  std::vector<Vec3> axes;       // of the hemispheres: towards the source, for SPP-H the ground's normal
  std::vector<float> down, up;  // [axis][cell], compensation included
};

// What a response is computed from: one band's optics by prototype, one ground.
struct ResponseMedium {
  std::span<const CanopyOptics> optics;
  double ground_albedo = 0;
  const CanopyAngles* angles = nullptr;  // given: SPP-H with the mean optics of the forest; else [SPP] Eq. 19
};

// `compensation` as above or empty for 1 everywhere.
SkyResponse sky_response(const Forest& forest, const ForestGrids& grids, const CellDepths& cells,
                         const ResponseMedium& medium, std::span<const float> compensation,
                         const RunControl& control);

// A change of sky: the sum over the sources.
ScatteredCells scattered_sky_light(const SkyResponse& response, std::span<const double> sources,
                                   const RunControl& control);

// A sky over a band that was not asked before: closed forms and their sum in one pass, the same numbers as
// scattered_sky_light(sky_response(...), sources) without keeping what each source leaves.
ScatteredCells scattered_sky_light(const Forest& forest, const ForestGrids& grids, const CellDepths& cells,
                                   const ResponseMedium& medium, std::span<const float> compensation,
                                   std::span<const double> sources, const RunControl& control);

// Mean optics of the forest's leaves and wood in a band, prototypes weighted by the leaf area of their
// instances.
CanopyOptics forest_optics(const Forest& forest, std::span<const CanopyOptics> optics);

}  // namespace sunfleck
