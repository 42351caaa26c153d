// Direct sunlight: one march of the leaf-area grid per element, ground cell and cell with wood; or, where
// someone else knows which elements are in the sun (a picture of the sun, shadow rays), marches for ground
// and wood alone.
//
// In a periodic scene all the sun that comes in is taken by something. Cells blur clumps, and let 1 to 5 % of
// a marched beam vanish: the shares of marched elements are scaled by one factor, what incoming sun is to
// what was taken, at most to 1. Depths before ground and wood are then scaled by another, by which they take
// the rest.
#pragma once

#include "lighting/depth/extinction_grid.h"
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

// The same for known shares of every element that the sun reaches, [0, 1]; of shoots of their needles, past
// their own shade.
void light_elements_as_known(DirectSun& sun, const BlockerField& field,
                             std::span<const float> sunlit_fraction, const Vec3& to_sun,
                             const RunControl& control);

// `to_sun` is unit and above the horizon. `sunlit_fraction`: as above, empty where not known.
DirectSun direct_sun(const TransportScene& scene, const Forest& forest, const Vec3& to_sun,
                     std::span<const float> sunlit_fraction, const RunControl& control);

}  // namespace sunfleck::transport
