// The answer: light on every foliage element, per band, with what is known about its error and its making.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/ids.h"

namespace sunfleck {

// Irradiance on one face, W m-2 of that face, split by its last way: straight from the sun, straight from the
// sky, or off leaves, wood and ground.
struct FaceLight {
  float direct_w_m2 = 0, sky_w_m2 = 0, scattered_w_m2 = 0;
  float total() const { return direct_w_m2 + sky_w_m2 + scattered_w_m2; }
};

struct ElementLight {
  FaceLight front, back;
  float absorbed_w = 0;  // area * sum over faces of (1 - r - t) * irradiance
};

// Where the light of a band went, W. `incident`: what falls on the period (periodic scene), else what sun,
// sky and ground beyond the scene put on the receivers first. incident = absorbed + escaped + residual.
struct EnergyBudget {
  double incident_w = 0;
  double absorbed_foliage_w = 0, absorbed_wood_w = 0, absorbed_ground_w = 0;
  double escaped_w = 0;                  // to the sky, or to ground beyond the scene
  double residual_w = 0;                 // what the estimate does not account for
  double residual_standard_error_w = 0;  // 0 where the method has no error estimate
};

struct TreeLight {
  TreeId tree;
  std::uint32_t instance = 0;
  double leaf_area_m2 = 0;
  double sunlit_leaf_area_m2 = 0;
  double absorbed_w = 0;
  double absorbed_standard_error_w = 0;  // 0 where the method has none
  double mean_irradiance_w_m2 = 0;       // front + back, area-weighted mean
};

struct BandLightMap {
  std::string band;
  std::vector<ElementLight> elements;      // in ForestIndex order
  std::vector<float> standard_error_w_m2;  // of front + back total irradiance; empty if the method has none
  std::vector<TreeLight> trees;            // in instance order
  EnergyBudget budget;
  bool has_budget = false;          // false for methods that follow no ground and no escape
  double mean_irradiance_w_m2 = 0;  // front + back, area-weighted over all elements
  double mean_irradiance_standard_error_w_m2 = 0;
};

// Something the scene did not need.
struct SkipNote {
  std::string what, reason;
  double relative_bound = 0;  // largest change of any result that it can cause, relative to the mean
};

struct StageTime {
  std::string stage;
  double wall_s = 0, cpu_s = 0;
};

struct Provenance {
  std::string method, version, forest_hash;
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, std::string>> settings;  // name with unit -> value, as used
  std::vector<SkipNote> skipped;
  std::vector<std::string> notes;  // limits of the method that this scene touches
  std::vector<StageTime> times;    // the only part that differs between two equal runs
};

struct LightMap {
  std::vector<float> sunlit_fraction;  // per element, share of its area the sun's centre sees, 0 with no sun
  std::vector<BandLightMap> bands;
  Provenance provenance;
};

}  // namespace sunfleck
