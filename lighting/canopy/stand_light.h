// Light for ecologists: what reaches trees, ground, layers and sensors of a stand over any period.
//
// Two steps. prepare_stand_light() traces the response of every target to each direction (DirectionalBasis:
// depends on the forest, the optics, the sensors and the directions). stand_light() is then a weighted sum
// per interval: hours of a year cost little more than one. A basis serves any weights on its own directions.
//
// Units: energies are in the unit of the weights (say MJ m-2 per interval): per m2 at sensors and on the
// ground, times m2 for trees, layers and the plot (so MJ). Shares are of the light over open ground.
// "Unscattered" light comes straight from sun or sky; "scattered" has met leaves, wood or ground and is given
// per optical band. Sensor tables hold unscattered light, as hemispherical photographs do.
//
// Small and middle stands: cost follows the rays (about a million per second and core). For stands of tens of
// thousands of trees see large_stand_light.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lighting/canopy/crown_potential.h"
#include "lighting/canopy/first_light.h"
#include "lighting/canopy/sensor_canopy.h"
#include "lighting/canopy/sensor_light.h"

namespace sunfleck {

struct StandLightRequest {
  StandSky sky;
  std::vector<LightSensor> sensors;
  bool scattering = true;     // per band of the optics; false: no band tables
  bool potential = true;      // what each tree would get alone
  bool canopy_views = false;  // openness, gaps and leaf area at the sensors
  CanopyOptions canopy;
  // Cost. Rays per ground cell over all directions together, shared out half by energy, half evenly.
  double rays_per_cell = 1000;  // (0, 1e7]
  // More rays than that, up to 100 times, until the standard error of 95 in 100 trees' intercepted light over
  // all intervals is below this, relative: 0.025 keeps 95 in 100 trees within about 5 %. 0: exactly
  // rays_per_cell.
  double tree_relative_error = 0.05;
  int potential_rays = 1000;  // per tree alone over all directions together, shared out alike, 1 .. 1e7
  int sensor_sun_rays = 4, sensor_sky_rays = 16;  // per sensor and direction, 1 .. 100,000
  std::uint64_t seed = 1;
};

struct DirectionalBasis {
  StandSky sky;  // checked; the weights that steered the rays
  std::vector<LightSensor> sensors;
  std::vector<SensorCanopy> canopy;  // per sensor where asked for
  StandResponse from_sun, from_sky;
  ResponseTable potential_sun_m2, potential_sky_m2;  // no directions where not asked for
  ResponseTable sensors_sun, sensors_sky;
};

// Throws Error(kInvalidInput) naming the field, see checked() of sky and sensors.
DirectionalBasis prepare_stand_light(const StandScene& scene, const OpticsTable& optics,
                                     const StandLightRequest& request, const RunControl& control);

// [interval][sensor]. Open: the same receiver with nothing in the way.
struct SensorTables {
  IntervalTable direct, diffuse, total;                 // energy per m2 of the receiver
  IntervalTable open_direct, open_diffuse;              // (no errors)
  IntervalTable pacl_direct, pacl_diffuse, pacl_total;  // shares above canopy light; 0 where there is none
  // Over all intervals together: direct site factor, indirect site factor, gap light index (0..1).
  std::vector<double> direct_site_factor, indirect_site_factor, gap_light_index;
};

// [interval][ground cell]
struct GroundTables {
  IntervalTable direct_share, diffuse_share;  // unscattered, of the open ground's direct and diffuse light
  IntervalTable total;                        // unscattered energy per m2 of map
  std::vector<IntervalTable> scattered;       // per band: energy per m2 of map
};

// [interval][instance of the forest]. Trees with virtual numbers (surroundings that nobody measured) have no
// potential, and in a forest that does not repeat only the light of rays that pass near what is asked about.
struct TreeTables {
  IntervalTable intercepted;            // energy, unscattered, leaves and wood
  IntervalTable potential;              // the same alone in the open
  std::vector<IntervalTable> absorbed;  // per band: energy in leaves, all bounces
  IntervalTable sunlit_leaf_area_m2;    // mean over the interval's direct light
  IntervalTable light_competition;      // intercepted / potential; 1: no neighbour takes anything
};

// [interval][layer]; height_share has one more: the foot of each layer, and the top.
struct LayerTables {
  double layer_m = 1;
  std::vector<double> leaf_area_m2;  // per layer
  IntervalTable intercepted, sunlit_leaf_area_m2;
  std::vector<IntervalTable> absorbed;  // per band
  IntervalTable light_share;            // unscattered light through a level plane there, over the map
};

// Energy, per interval. unscattered: sent = leaves + wood + ground + beyond + missed. Per band: sent =
// absorbed by leaves, wood, ground, + reflected to the sky, + ground beyond + missed. Both close to rounding.
struct PlotBand {
  std::string band;
  std::vector<double> leaves, wood, ground, reflected, beyond;
  std::vector<double> ground_scattered;  // scattered light that arrives on the map's ground
  std::vector<double> fapar;             // leaves / light on the map's area
  std::vector<double> albedo;            // reflected / sent
  std::vector<double> transmittance;     // light on the map's ground / light on the map's area
};
struct PlotTables {
  std::vector<double> on_map;  // open light on the map's area
  std::vector<double> sent;    // light that was followed: periodic forests: the same
  std::vector<double> leaves, wood, ground, beyond, missed;
  std::vector<PlotBand> bands;
  double leaf_area_index = 0;
  std::vector<double> zenith_deg, leaf_projection;  // G, every 5 degrees
};

struct StandLight {
  std::vector<std::string> intervals;
  std::vector<TreeId> tree_ids;  // per instance
  std::vector<double> tree_leaf_area_m2;
  StandGround map;
  SensorTables sensors;
  std::vector<SensorCanopy> canopy;
  GroundTables ground;
  TreeTables trees;
  LayerTables layers;
  PlotTables plot;
};

// `sun` and `sky`: strengths on the directions of the basis, one row per label of `intervals`; Error as
// checked().
StandLight stand_light(const StandScene& scene, const DirectionalBasis& basis, const WeightRows& sun,
                       const WeightRows& sky, const std::vector<std::string>& intervals,
                       const RunControl& control);
// Both steps.
StandLight stand_light(const StandScene& scene, const OpticsTable& optics, const StandLightRequest& request,
                       const RunControl& control);

}  // namespace sunfleck
