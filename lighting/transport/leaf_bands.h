// Optics of leaves and wood in one band, as the grid uses them.
#pragma once

#include <algorithm>
#include <vector>

#include "lighting/optics/optics.h"
#include "sim/forest/forest.h"

namespace sunfleck::transport {

// Of a class of elements, see LeafClasses.
struct LeafBand {
  float reflectance_front = 0, reflectance_back = 0, transmittance_front = 0, transmittance_back = 0;
  float albedo = 0;  // mean of the faces
};
std::vector<LeafBand> leaf_bands(const Forest& forest, const OpticsTable& optics, std::size_t band);
// By wood area, 0 without wood.
double mean_bark_reflectance(const Forest& forest, const OpticsTable& optics, std::size_t band);

// Irradiance or radiosity, W m-2, of both faces.
struct FacePair {
  float front = 0, back = 0;
};

// How much more light needles of a shoot get than comes from outside the shoot.
inline float shoot_gain(float albedo, float escape) {
  return 1.0f / std::max(1e-4f, 1.0f - albedo * (1.0f - escape));
}

// Radiosity for this irradiance of a flat element, or of a shoot, whose needles face everywhere.
inline FacePair radiosity_of(const LeafBand& leaf, bool is_shoot, const FacePair& light) {
  const float even = 0.5f * leaf.albedo * (light.front + light.back);
  if (is_shoot) return {even, even};
  return {leaf.reflectance_front * light.front + leaf.transmittance_back * light.back,
          leaf.reflectance_back * light.back + leaf.transmittance_front * light.front};
}

}  // namespace sunfleck::transport
