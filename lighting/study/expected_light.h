// What sensors are to expect in a stand of which only the inventory is known: the mean over several stands
// that agree with it (realisations: other places of leaves, clumps, understorey and virtual trees around the
// plot). One realisation is a possible forest, not the measured one: its own chance adds to the error at each
// sensor.
#pragma once

#include <string>
#include <vector>

#include "lighting/study/stand_study.h"
#include "sim/forest/forest_spec.h"
#include "sim/plant/species.h"

namespace sunfleck {

// Over the whole period; per sensor of the study.
struct ExpectedLight {
  int realisations = 0;
  std::vector<double> pacl, pacl_direct, pacl_diffuse;  // means
  std::vector<double> pacl_spread;  // standard deviation of pacl between realisations; 0 with one
  double leaf_area_index = 0;       // mean
  std::vector<std::string> notes;   // of growing the first one
};

// Seeds of the realisations follow from forest.seed; the first has that seed itself. Only sensors are
// computed (by rays). Throws Error: no sensors, fewer than 1 or more than 1000 realisations, and what growing
// and light throw.
ExpectedLight expected_light(const ForestSpec& forest, const SpeciesLibrary& species,
                             const StandStudySpec& study, int realisations, const RunControl& control);

}  // namespace sunfleck
