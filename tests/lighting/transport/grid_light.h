// The grid method on the small scenes of the traced reference's tests.
#pragma once

#include "lighting/transport/grid_estimator.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {

inline LightMap grid_light(const Forest& forest, double soil_albedo, const Illumination& light,
                           const GridOptions& options = {}) {
  return grid_light_map(forest, optics_of(forest, soil_albedo), light, options, {});
}

// Table of `bands` of a generated scene ("VIS", "PAR", "NIR").
inline OpticsTable band_optics(const Forest& forest, std::vector<std::string> bands, double soil_albedo) {
  OpticsRequest request;
  request.soil_albedo.assign(bands.size(), soil_albedo);
  request.bands = std::move(bands);
  return OpticsTable(forest, request);
}

// A level leaf of 0.1 m x 0.1 m, 1 m above the ground, turned so that its front looks towards `normal`.
inline FoliageElement leaf_towards(const Vec3& normal, double side_m = 0.1,
                                   const Vec3& centre_m = {0, 0, 1}) {
  const Basis basis = basis_around(glm::normalize(normal));
  return quad(centre_m, 0.5 * side_m * basis.tangent, 0.5 * side_m * basis.bitangent);
}

// Mean over elements of front + back of one part of the light; all elements of one area.
inline double mean_of(const BandLightMap& band, float FaceLight::*part) {
  double sum = 0.0;
  for (const ElementLight& e : band.elements) sum += static_cast<double>(e.front.*part) + e.back.*part;
  return sum / static_cast<double>(band.elements.size());
}

}  // namespace sunfleck::test
