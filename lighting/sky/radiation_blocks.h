// Private to lighting/sky: the rows of a table that a period needs, as spans of time with their energy.
#pragma once

#include <vector>

#include "lighting/sky/radiation_series.h"

namespace sunfleck {

// One row at one time (a row for "every May" makes a block per year).
struct RadiationBlock {
  double begin_s = 0, end_s = 0;
  double global_j_m2 = 0;
  const RadiationRow* row = nullptr;
};

// Blocks that cover the period without gaps, in the order of time. Throws at the table's name for what lacks.
std::vector<RadiationBlock> blocks_of(const RadiationTable& table, const TimeSpan& period);

// The sun and radiation outside the atmosphere over a block's steps.
struct BlockSun {
  double step_s = 0;
  std::vector<SunPosition> sun;               // at the middle of each step
  std::vector<double> extraterrestrial_w_m2;  // horizontal
  double extraterrestrial_j_m2 = 0;           // horizontal, of the block
};
BlockSun sun_over(const RadiationBlock& block, const Place& place, const SunTrack& track, double step_s);

// Throws at the row if the block's energy cannot be.
void check_not_too_much(const RadiationBlock& block, const BlockSun& sun, const RadiationTable& table);
// Throws at the table's name if all blocks together are darker than any climate.
void check_not_too_little(double global_j_m2, double extraterrestrial_j_m2, double days,
                          const RadiationTable& table);

}  // namespace sunfleck
