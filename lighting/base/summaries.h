// Sums every estimator needs and checks every result must pass.
#pragma once

#include "lighting/base/light_map.h"
#include "lighting/optics/optics.h"
#include "sim/forest/forest.h"

namespace sunfleck {

// Fills absorbed_w of every element, the trees and the means of every band from the face irradiances. Tree
// standard errors are left alone where trees are already there (matching instance order), else 0.
void summarize(const Forest& forest, const ForestIndex& index, const OpticsTable& optics, LightMap& map);

// The invariants of every result: sizes match the forest, everything finite, nothing negative, sunlit
// fraction in [0, 1], absorbed never more than received. Returns the first violation as a sentence, empty if
// there is none.
std::string find_violation(const LightMap& map, const ForestIndex& index);

// Adds wall and CPU seconds of a stage to a provenance when it goes out of scope.
class StageTimer {
 public:
  StageTimer(Provenance& provenance, std::string stage);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  Provenance& provenance_;
  std::string stage_;
  double wall_start_s_, cpu_start_s_;
};

}  // namespace sunfleck
