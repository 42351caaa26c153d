// Direct sunlight: one march of the leaf-area grid per element, ground cell and cell with wood.
#pragma once

#include "lighting/transport/leaf_scattering.h"
#include "lighting/transport/transport_scene.h"

namespace sunfleck::transport {

// For a beam of 1 W m-2.
struct DirectSun {
  std::vector<FacePair> elements;      // irradiance
  std::vector<float> sunlit_fraction;  // of elements
  std::vector<float> ground;           // irradiance of ground cells
  std::vector<float> wood;             // transmittance to cells with wood, times their wood_depths()
  double open_ground = 0;              // irradiance of the open ground
};

// Light of every element for its depth towards the sun; fills `elements` and `sunlit_fraction`.
void light_elements(DirectSun& sun, const BlockerField& field, std::span<const float> depths,
                    const Vec3& to_sun, const RunControl& control);

// `to_sun` is unit and above the horizon.
DirectSun direct_sun(const TransportScene& scene, const Forest& forest, const Vec3& to_sun,
                     const RunControl& control);

}  // namespace sunfleck::transport
