// From light along every sector to irradiance on both faces of a leaf or of the needles of a shoot.
#pragma once

#include <array>

#include "lighting/envelope/arriving_light.h"

namespace sunfleck::envelope {

// Irradiance of a face per radiance of a sector, sr, and per beam.
struct FaceWeights {
  std::array<float, kMostSectors> front{}, back{};
  double sun_front = 0, sun_back = 0;  // per beam irradiance, no leaf in the way
  double own_sun = 1;  // share of the sun that needles of the same shoot let through, 1 for a leaf
  double escape = 1;   // share of light scattered in the element that leaves it
};
FaceWeights flat_weights(const SectorSet& set, const Vec3& normal, const Vec3& to_sun,
                         EnvelopeWeights weights);
FaceWeights shoot_weights(const SectorSet& set, const FieldElement& shoot, const Vec3& to_sun);

// `albedo` is the element's own in this band (needles of a shoot light each other); absorbed_w stays 0.
ElementLight element_light(const FaceWeights& weights, const ArrivingBand& light, std::size_t sectors,
                           double beam_seen_w_m2, double albedo);

}  // namespace sunfleck::envelope
