// Benchmark rows as tables and plots.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lighting/bench/error_against_time.h"
#include "lighting/bench/machine.h"
#include "lighting/map/plot.h"

namespace sunfleck {

// One line per row, errors relative, times in seconds, with seed, commit and machine on every line, so that
// files can be joined.
std::string benchmark_csv(const std::vector<BenchmarkRow>& rows, int threads, const MachineFacts& machine);

// One panel per scene and band: RMS error per element against CPU time, a line per method, and the front:
// steps that no other beats in both.
PlotPage pareto_page(const std::vector<BenchmarkRow>& rows, const MachineFacts& machine);

// Indexes of the rows that no other row of the same scene and band beats in error and CPU time, cheapest
// first.
std::vector<std::size_t> pareto_front(const std::vector<BenchmarkRow>& rows, const std::string& scene,
                                      const std::string& band);

}  // namespace sunfleck
