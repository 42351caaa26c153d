// Whether a scene keeps the conditions under which envelope_full's figures hold: for machines to choose by,
// and for the notes of an answer that was forced.
#pragma once

#include <string>
#include <vector>

#include "lighting/envelope/envelope_full.h"

namespace sunfleck {

// One condition: met where `value` lies on the right side of `limit`.
struct EnvelopeCondition {
  std::string name;  // fewest_elements, cell_sides, coarse_cells, light_spread, clamped_share
  double value = 0, limit = 0;
  bool met = true;
  std::string consequence;  // in words, for the user
};

struct EnvelopeSuitability {
  bool suitable = true;  // all conditions are met
  std::vector<EnvelopeCondition> conditions;
};

// light_spread: largest a p over the bands, a the leaf albedo and p the mean chance of meeting foliage again,
// in a closed canopy (periodic scene); above 0.5 its layers' scattered light is off by more than 10 %.
EnvelopeSuitability envelope_suitability(const Forest& forest, const OpticsTable& optics,
                                         const EnvelopePrepared& prepared);

}  // namespace sunfleck
