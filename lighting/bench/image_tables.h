// Rows of image errors as tables and plots.
#pragma once

#include <string>
#include <vector>

#include "lighting/bench/image_errors.h"
#include "lighting/bench/machine.h"
#include "lighting/map/plot.h"

namespace sunfleck {

// For a terminal: a head and one line per row.
std::string image_table(const ImageBenchmark& benchmark);

// One line per row, errors relative, times in seconds, with seed, commit and machine on every line.
std::string image_csv(const std::vector<ImageBenchmark>& benchmarks, int threads,
                      const MachineFacts& machine);

// One panel per scene: RMSE against CPU time, a line per way, samples beside the points.
PlotPage image_page(const std::vector<ImageBenchmark>& benchmarks, const MachineFacts& machine);

}  // namespace sunfleck
