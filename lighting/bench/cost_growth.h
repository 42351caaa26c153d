// How the cost of a method grows with the size of the question, with the error of every answer measured by
// probes in the same run.
#pragma once

#include <string>
#include <vector>

#include "lighting/bench/machine.h"
#include "lighting/bench/method_ladder.h"
#include "lighting/map/plot.h"

namespace sunfleck {

enum class GrowthKind {
  kLeaves,     // one ball of crown LAI 5, 1e3 to 1e6 leaves
  kInstances,  // 1 to 1e4 clumped crowns of 1,000 leaves in rows, periodic
  kBands,      // 1 to 16 bands of the same ball of 20,000 leaves
  kSuns        // 1 to 100 places of the sun over the same ball, asked of one session
};
std::string to_string(GrowthKind kind);  // leaves, instances, bands, suns

struct GrowthRow {
  GrowthKind kind = GrowthKind::kLeaves;
  std::string method, knob;
  double count = 0;  // of what grows
  std::size_t elements = 0;
  double wall_s = 0, cpu_s = 0;
  double bias = 0, bias_low = 0, bias_high = 0;                       // relative, 95 % interval
  double element_rms = 0, element_rms_low = 0, element_rms_high = 0;  // relative, 95 % interval
};

struct GrowthPlan {
  std::vector<MethodStep> steps;
  std::size_t most_elements = 1'000'000;  // larger questions are left out
  double longest_s = 60;                  // after an answer that took longer, no larger one of its step
  int repeats = 1;
  CostOptions cost{1};
  std::uint64_t seed = 1;
};

std::vector<GrowthRow> cost_growth(GrowthKind kind, const GrowthPlan& plan, const RunControl& control);

// Exponent p of cpu ~ count^p by least squares over the rows of one step with at least `from` of what grows;
// NaN with fewer than two.
double growth_exponent(const std::vector<GrowthRow>& rows, const std::string& method, const std::string& knob,
                       double from);

std::string growth_csv(const std::vector<GrowthRow>& rows, int threads, const MachineFacts& machine);
PlotPage growth_page(const std::vector<GrowthRow>& rows, const MachineFacts& machine);

}  // namespace sunfleck
