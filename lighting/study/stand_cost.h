// What a stand study will take, from its sizes alone: said before anything is computed.
#pragma once

#include <cstddef>

#include "lighting/study/stand_study.h"

namespace sunfleck {

// Months, days or hours of the period's clock that it touches; 1 for kPeriod.
std::size_t interval_count(const TimeSpan& period, IntervalKind kind);

struct StandCost {
  StandEngine engine = StandEngine::kRays;
  std::size_t intervals = 1;  // besides the whole period
  double ground_cells = 0;    // of the map
  double rays = 0;            // light on the stand, at least; 0 for boxes
  // At most, beside the forest and the ray scene over it: responses to every direction (half of the sky's
  // bins count as visited by the sun), weights of every interval, the tables and one copy of them.
  double memory_bytes = 0;
  double result_bytes = 0;  // of all tables
};
StandCost predicted_cost(const Forest& forest, const StandStudySpec& spec);

}  // namespace sunfleck
