// A stand, a place and a period: everything an ecologist asks of a stand's light, as one question and one
// answer. The engine is lighting/canopy, the sun's paths and the sky are lighting/sky.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/canopy/large_stand.h"
#include "lighting/canopy/stand_light.h"
#include "lighting/optics/optics.h"
#include "lighting/sky/par.h"
#include "lighting/sky/sky_weights.h"
#include "lighting/study/sensor_table.h"
#include "sim/base/run_control.h"
#include "sim/config/config_table.h"
#include "sim/forest/forest.h"

namespace sunfleck {

enum class StandEngine {
  kAuto,  // rays up to 5,000 trees and 250,000 ground cells, else boxes
  kRays,  // through the real elements: all outputs, with standard errors
  kBoxes  // sweeps of a leaf-area grid: ground map and trees, no scattering, no sensors
};
std::string to_string(StandEngine engine);  // "auto", "rays", "boxes"

struct StandStudySpec {
  Place place;
  TimeSpan period;
  std::filesystem::path radiation;                // file, see lighting/sky/radiation_table.h
  std::optional<RadiationTable> radiation_table;  // instead of the file; `radiation` is then its name only
  SkyModel sky = SkyModel::kStandardOvercast;
  IntervalKind intervals = IntervalKind::kMonth;  // besides the whole period
  std::vector<SensorRow> sensors;
  OpticsRequest optics;  // bands for what leaves absorb
  ParFactors par;
  double ground_cell_m = 5, layer_m = 1;
  std::optional<Vec2> map_lo_m, map_hi_m;  // the part of the ground asked about; else period or forest bounds
  // Ground of the inventoried plot. With virtual trees around it, leaf area index and absorbed fraction are
  // those of the plot's own trees over this area; 0: of all trees over the map.
  double plot_area_m2 = 0;
  StandEngine engine = StandEngine::kAuto;
  bool scattering = true;
  bool canopy_views = true;  // openness, gaps, leaf area at the sensors
  double rays_per_cell = 1000;
  double tree_relative_error = 0.05;  // of 95 in 100 trees, by more rays than that; 0: no aim
  int sensor_sun_rays = 16, sensor_sky_rays = 16;
  double patch_deg = 0, bin_deg = 0;  // 0: 6 and 5 by rays, 12 and 10 by boxes, see with_directions()
  std::uint64_t seed = 1;
};

// Reads the [stand_light] table of a scene file; paths are relative to the file. Keys: see
// configs/scenes/README.md.
StandStudySpec read_stand_study(const ConfigTable& table);

// Measured against modelled share of above-canopy light, over the sensors that carry a measurement.
struct SensorFit {
  std::size_t sensors = 0;
  double rmse = 0, bias = 0, correlation = 0;  // correlation: NaN with fewer than two or without spread
};
SensorFit sensor_fit(const std::vector<double>& modelled, const std::vector<double>& measured);

struct StandStudy {
  StandStudySpec spec;
  // Energies in MJ m-2 (or MJ) of global radiation; the PAR band's share is in `spec.par`.
  std::optional<StandLight> period, parts;  // by rays: one interval, and one per month, day or hour
  std::optional<LargeStandLight> world;     // by boxes
  std::vector<double> direct_horizontal_mj_m2, diffuse_horizontal_mj_m2;  // open: period first, then parts
  std::vector<std::string> intervals;                                     // the same
  std::vector<double> interval_begin_s, interval_end_s;  // the same: seconds since 2000-01-01T00:00 UTC
  std::optional<SensorFit> fit;                          // where at least two sensors carry a measurement
  Provenance provenance;
};

// The engine of a study: kRays or kBoxes.
StandEngine chosen_engine(const Forest& forest, const StandStudySpec& spec);
// With the edges of sky patches and sun bins that nobody stated: boxes sweep the whole stand for each
// direction and are right to a few per cent only, so they get a quarter as many.
StandStudySpec with_directions(const Forest& forest, StandStudySpec spec);

// Throws Error for bad input (see the parts), kCancelled, kLimitExceeded.
StandStudy run_stand_study(const Forest& forest, const StandStudySpec& spec, const RunControl& control);

}  // namespace sunfleck
