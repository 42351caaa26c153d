// Light of a set of directions on trees, ground and layers by rays through the real elements: what every ray
// meets first (all energy is accounted for, ray by ray), and for each band the bounces after that.
//
// Bounces: a ray that meets a surface of reflectance r and transmittance t is taken with the chance 1 - r - t
// and goes on otherwise, Lambertian; unbiased for all orders, and every ray ends in exactly one place. PAR
// (r + t about 0.15) costs a fifth more than no bounces, NIR (0.9) ten times.
#pragma once

#include <string>
#include <vector>

#include "lighting/canopy/light_weights.h"
#include "lighting/canopy/response_table.h"
#include "lighting/canopy/stand_scene.h"
#include "lighting/optics/optics.h"

namespace sunfleck {

// All amounts are m2 of facing light unless they are shares.
struct BandResponse {
  std::string band;
  ResponseTable tree_absorbed_m2;        // by leaves, per instance
  ResponseTable layer_absorbed_m2;       // by leaves
  ResponseTable ground_scattered_share;  // of a cell: light off leaves, wood and ground, of open-sky light
  // Per direction: one value each (targets = kPlotTerms).
  enum PlotTerm : std::size_t { kLeaves, kWood, kGroundAbsorbed, kReflected, kBeyond, kPlotTerms };
  ResponseTable plot_m2;
};

struct StandResponse {
  ResponseTable ground_share;         // unscattered light on each ground cell, of open-sky light
  ResponseTable tree_intercepted_m2;  // by leaves and wood, before any scattering
  ResponseTable tree_sunlit_m2;       // leaf area that light of the direction falls on (one side of a leaf)
  ResponseTable layer_intercepted_m2, layer_sunlit_m2;
  ResponseTable height_share;  // unscattered light at the foot of each layer over the map, and at the top
  // Over all light sent: leaves, wood, ground of the map, ground beyond, missed (to the sky: 0 over a plane).
  enum PlotTerm : std::size_t { kIncident, kLeaves, kWood, kMapGround, kBeyond, kMissed, kPlotTerms };
  ResponseTable plot_m2;
  std::vector<BandResponse> bands;
};

struct DropOptions {
  std::uint64_t seed = 1;
  std::vector<double> rays_on_map;  // per direction: how many rays aim at the map; 0 skips the direction
  bool bounces = true;              // false: StandResponse::bands stay empty
};

// Progress stage "light on the stand". The same for any number of threads.
StandResponse drop_light(const StandScene& scene, const OpticsTable& optics, const LightSource& source,
                         const DropOptions& options, const RunControl& control);

}  // namespace sunfleck
