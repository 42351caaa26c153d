// Direct sunlight: one march of the leaf-area grid per element, ground cell and cell with wood; or, where
// someone else knows which elements are in the sun (a picture of the sun, shadow rays), marches for ground
// and wood alone. In a periodic scene what such elements leave of the sun is shared by ground and wood in the
// proportions of their marches, so that all that comes in is taken by something.
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

// Depth of the grid from every element towards its sun. Leaf by leaf of one cell after the other: their ways
// through the grid are nearly the same and stay in the cache.
std::vector<float> sun_depths(const CellContents& contents, const BlockerField& field,
                              const ExtinctionGrid& grid, const RunControl& control);

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
