// Error of pictures against the samples they took and the time they needed, for every way to a picture, on
// one scene, measured together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lighting/bench/image_figures.h"
#include "lighting/bench/image_ways.h"
#include "lighting/plan/light_request.h"

namespace sunfleck {

// What is to be seen, and in which light.
struct ImageTask {
  Forest forest;
  LightRequest light;          // its method makes the light map that light-map ways need
  Camera camera;               // its samples and seed are set by the plan
  std::vector<ImageWay> ways;  // the first: path-traced
};

struct ImagePlan {
  std::vector<int> samples = {1, 4, 16, 64};  // per pixel, rising
  int reference_samples = 1024;               // of both halves together
  int repeats = 2;                            // pictures of other seeds per row; 2 at least
  int threads = 1;                            // 0: all cores
  std::uint64_t seed = 1;
};

struct ImageRow {
  std::string scene, way;
  int samples = 0, width_px = 0, height_px = 0;
  std::size_t elements = 0, instances = 0;
  ImageFigures error;
  double wall_s = 0, cpu_s = 0;  // of one picture with all that it prepares, but not its light map: medians
  std::uint64_t peak_memory_bytes = 0;  // of the process
  // Against path tracing in the same run. NaN: not known (a single number of samples, an error below the
  // reference's noise, or less time than path tracing takes to prepare).
  double path_traced_rmse_at_equal_time = 0;
  double times_cheaper_at_equal_error = 0;  // CPU time of path tracing to this error over this picture's
  std::uint64_t seed = 0;
};

struct ImageBenchmark {
  std::vector<ImageRow> rows;  // way by way
  int reference_samples = 0;
  double reference_noise = 0;    // RMS standard error per pixel, relative to the mean brightness
  std::string light_map_method;  // empty: none was needed
  double light_map_cpu_s = 0;
};

// Checks before it times: each way's picture must be finite and the same twice for one seed, and the
// path-traced mean must agree with its reference within 5 standard errors, or ContractViolation is thrown. A
// way that refuses the scene gives no rows and one line in `refused`. Throws Error(kInvalidInput) for a
// scene that is dark.
ImageBenchmark image_errors(const ImageTask& task, const ImagePlan& plan, std::vector<std::string>& refused,
                            const RunControl& control);

// Fills the two comparisons of rows of one scene from its path-traced ones: time = setup + samples * time per
// sample through the first and last of them, error by 1 / sqrt(samples) from the one of nearest error.
void compare_with_path_tracing(std::vector<ImageRow>& rows);

}  // namespace sunfleck
