#include "lighting/bench/image_errors.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lighting/bench/machine.h"
#include "lighting/bench/stopwatch.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr std::uint64_t kTruthSeed = 1'000'000;  // away from those of the repeats
constexpr double kMostStandardErrors = 5;        // a false alarm in 2e6 honest rows

// What every picture of a task is made from.
struct Studio {
  const ImageTask& task;
  OpticsTable optics;
  Illumination light;
  std::optional<LightMap> map;

  explicit Studio(const ImageTask& t)
      : task(t),
        optics(t.forest, t.light.optics),
        light(checked(t.light.light, t.light.optics.bands.size())) {}
};

Image take(const Studio& studio, const RenderSettings& settings, int samples, std::uint64_t seed,
           const RunControl& control) {
  Camera camera = studio.task.camera;
  camera.samples_per_pixel = samples;
  camera.seed = seed;
  const RenderRequest request = picture_request(settings, camera, studio.light);
  if (settings.mode == RenderMode::kPathTraced)
    return render_path_traced(studio.task.forest, studio.optics, request, control);
  return render(studio.task.forest, studio.optics, *studio.map, request, control);
}

ImageTruth make_truth(const Studio& studio, const ImagePlan& plan, const RunControl& control) {
  const RenderSettings& settings = studio.task.ways.front().settings;
  const int half = (plan.reference_samples + 1) / 2;
  const std::uint64_t seed = plan.seed + kTruthSeed;
  const Image first = take(studio, settings, half, seed, control);
  const ImageTruth truth = image_truth(first, take(studio, settings, half, seed + 1, control));
  if (!(truth.brightness > 0.0))
    throw_invalid("scene " + studio.task.forest.name, "the picture is black",
                  "a camera and light that show something");
  return truth;
}

void refuse_unsteady(const Studio& studio, const ImageWay& way, const ImagePlan& plan,
                     const RunControl& control) {
  const Image once = take(studio, way.settings, plan.samples.front(), plan.seed, control);
  const Image again = take(studio, way.settings, plan.samples.front(), plan.seed, control);
  if (once.rgb != again.rgb) throw ContractViolation(way.name + " gave two pictures for one request");
  const auto finite = [](float v) { return std::isfinite(v); };
  if (!std::all_of(once.rgb.begin(), once.rgb.end(), finite))
    throw ContractViolation(way.name + " gave a picture that is not finite");
}

void refuse_wrong_mean(const ImageFigures& error) {
  if (std::fabs(error.bias) > kMostStandardErrors * error.bias_standard_error)
    throw ContractViolation("path tracing misses its own reference");
}

ImageRow measure(const Studio& studio, const ImageWay& way, int samples, const ImageTruth& truth,
                 const ImagePlan& plan, const RunControl& control) {
  std::vector<Image> repeats;
  std::vector<double> wall, cpu;
  reset_peak_memory();
  for (int i = 0; i < plan.repeats; ++i) {
    const Stopwatch watch;
    repeats.push_back(
        take(studio, way.settings, samples, plan.seed + static_cast<std::uint64_t>(i), control));
    wall.push_back(watch.wall_s());
    cpu.push_back(watch.cpu_s());
  }
  ImageRow row;
  row.scene = studio.task.forest.name;
  row.way = way.name;
  row.samples = repeats.front().samples_per_pixel;
  row.width_px = studio.task.camera.width_px, row.height_px = studio.task.camera.height_px;
  row.elements = ForestIndex(studio.task.forest).element_count();
  row.instances = studio.task.forest.instances.size();
  row.peak_memory_bytes = peak_memory_bytes();
  row.error = compare(truth, repeats);
  row.wall_s = median(wall), row.cpu_s = median(cpu);
  row.seed = plan.seed;
  return row;
}

void add_way(const Studio& studio, const ImageWay& way, const ImageTruth& truth, const ImagePlan& plan,
             const RunControl& control, std::vector<ImageRow>& rows) {
  refuse_unsteady(studio, way, plan, control);
  std::vector<ImageRow> measured;
  for (const int samples : plan.samples) {
    measured.push_back(measure(studio, way, samples, truth, plan, control));
    if (way.name == studio.task.ways.front().name) refuse_wrong_mean(measured.back().error);
  }
  rows.insert(rows.end(), measured.begin(), measured.end());
}

void light_the_leaves(Studio& studio, const ImagePlan& plan, ImageBenchmark& result,
                      const RunControl& control) {
  const auto& ways = studio.task.ways;
  if (std::none_of(ways.begin(), ways.end(),
                   [](const ImageWay& way) { return way.settings.mode == RenderMode::kLightMap; }))
    return;
  const Stopwatch watch;
  studio.map = compute_light_map(studio.task.forest, studio.task.light, {plan.threads}, control);
  result.light_map_method = to_string(studio.task.light.method);
  result.light_map_cpu_s = watch.cpu_s();
}

ImageBenchmark measure_all(const ImageTask& task, const ImagePlan& plan, std::vector<std::string>& refused,
                           const RunControl& control) {
  Studio studio(task);
  ImageBenchmark result;
  light_the_leaves(studio, plan, result, control);
  const ImageTruth truth = make_truth(studio, plan, control);
  result.reference_samples = 2 * ((plan.reference_samples + 1) / 2);
  result.reference_noise = truth.noise;
  for (const ImageWay& way : task.ways) {
    try {
      add_way(studio, way, truth, plan, control, result.rows);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::kCancelled) throw;
      refused.push_back(task.forest.name + ", " + way.name + ": " + error.what());
    }
  }
  compare_with_path_tracing(result.rows);
  return result;
}

// ---- against path tracing

struct PathTracing {
  std::vector<const ImageRow*> rows;
  double setup_s = 0, per_sample_s = 0;
};

PathTracing path_tracing_of(const std::vector<ImageRow>& rows) {
  PathTracing path;
  for (const ImageRow& row : rows)
    if (row.way == rows.front().way) path.rows.push_back(&row);
  const ImageRow &first = *path.rows.front(), &last = *path.rows.back();
  if (last.samples > first.samples) {
    path.per_sample_s = (last.cpu_s - first.cpu_s) / (last.samples - first.samples);
    path.setup_s = std::max(0.0, first.cpu_s - path.per_sample_s * first.samples);
  }
  return path;
}

const ImageRow& of_nearest_error(const PathTracing& path, double rmse) {
  const auto apart = [&](const ImageRow* row) { return std::fabs(std::log(row->error.rmse / rmse)); };
  return **std::min_element(path.rows.begin(), path.rows.end(),
                            [&](auto* a, auto* b) { return apart(a) < apart(b); });
}

const ImageRow& of_nearest_samples(const PathTracing& path, double samples) {
  const auto apart = [&](const ImageRow* row) { return std::fabs(std::log(row->samples / samples)); };
  return **std::min_element(path.rows.begin(), path.rows.end(),
                            [&](auto* a, auto* b) { return apart(a) < apart(b); });
}

double rmse_in_time(const PathTracing& path, double cpu_s) {
  const double samples = (cpu_s - path.setup_s) / path.per_sample_s;
  if (!(samples >= 1.0)) return std::nan("");
  const ImageRow& near = of_nearest_samples(path, samples);
  return near.error.rmse * std::sqrt(near.samples / samples);
}

double time_to_rmse(const PathTracing& path, double rmse) {
  if (!(rmse > 0.0)) return std::nan("");
  const ImageRow& near = of_nearest_error(path, rmse);
  return path.setup_s + path.per_sample_s * near.samples * std::pow(near.error.rmse / rmse, 2);
}

}  // namespace

void compare_with_path_tracing(std::vector<ImageRow>& rows) {
  if (rows.empty()) return;
  const PathTracing path = path_tracing_of(rows);
  const bool known = path.per_sample_s > 0.0;
  for (ImageRow& row : rows) {
    row.path_traced_rmse_at_equal_time = known ? rmse_in_time(path, row.cpu_s) : std::nan("");
    row.times_cheaper_at_equal_error = known ? time_to_rmse(path, row.error.rmse) / row.cpu_s : std::nan("");
  }
}

ImageBenchmark image_errors(const ImageTask& task, const ImagePlan& plan, std::vector<std::string>& refused,
                            const RunControl& control) {
  SUNFLECK_EXPECTS(!task.ways.empty() && !plan.samples.empty() && plan.repeats >= 2);
  SUNFLECK_EXPECTS(task.ways.front().settings.mode == RenderMode::kPathTraced);
  ImageBenchmark result;
  with_threads(plan.threads, [&] { result = measure_all(task, plan, refused, control); });
  return result;
}

}  // namespace sunfleck
