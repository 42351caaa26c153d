// One attempt of `auto`: a map, corrected or not, and what the probes say of it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lighting/plan/auto_correction.h"
#include "lighting/plan/auto_groups.h"
#include "lighting/plan/auto_options.h"
#include "lighting/plan/auto_probe.h"

namespace sunfleck {

struct JudgedBand {
  std::optional<Correction> correction;
  ErrorSample sample;                // of the light with the correction; each probe by a fit without it
  std::optional<ErrorSample> group;  // of the measure's groups, where it has any
};

struct Attempt {
  std::string name;
  LightMap map;  // corrected, sums updated
  std::vector<JudgedBand> bands;
  double worst_error = 0;  // in the tolerance's measure, over the bands
  bool tolerable = false;
};

struct Judge {
  const Forest& forest;
  const ForestIndex& index;
  const OpticsTable& optics;
  const ProbeSet& probes;
  const GroupProbes* groups;  // null for measures without groups
  const AutoOptions& options;
  std::span<const float> close_cover;  // per element; empty: no corrections by it

  // Finds the best correction of each band among `forms` (which all keep direct light, or none does), applies
  // it and measures.
  Attempt judge(std::string name, LightMap map, const std::vector<CorrectionForm>& forms) const;
};

}  // namespace sunfleck
