// bench images: error and time of every way to a picture against its samples.
#include <cstdio>

#include "lighting/bench/image_scenes.h"
#include "lighting/bench/image_tables.h"
#include "lighting/render/camera_config.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

void check_range(const std::string& option, double value, double low, double high, const char* range) {
  if (!(value >= low && value <= high))
    throw_invalid(option, "is " + std::to_string(static_cast<long>(value)), range);
}

void check(const BenchOptions& o) {
  check_range("--reference-samples", o.reference_samples, 2, 8192, "2 to 8192");
  check_range("--repeats", o.repeats, 2, 1000, "2 to 1000: their differences tell the noise");
  for (std::size_t i = 0; i < o.samples.size(); ++i) {
    check_range("--samples", o.samples[i], 1, 4096, "1 to 4096 each");
    if (i > 0 && o.samples[i] <= o.samples[i - 1])
      throw_invalid("--samples", "do not rise", "for example 1,4,16,64");
  }
  std::vector<Output> outputs;
  if (!o.csv.empty()) outputs.push_back({"--csv", o.csv, ".csv"});
  if (!o.plot.empty()) outputs.push_back({"--plot", o.plot, o.plot.extension() == ".png" ? ".png" : ".svg"});
  if (!outputs.empty()) check_outputs("bench images", outputs);
}

ImagePlan plan_of(const BenchOptions& o) {
  ImagePlan plan;
  if (!o.samples.empty()) plan.samples = o.samples;
  plan.reference_samples = o.reference_samples;
  plan.repeats = o.repeats;
  plan.threads = o.threads;
  plan.seed = o.seed;
  return plan;
}

// The scene file's own forest, light, camera and look.
ImageScene scene_of(const BenchOptions& o) {
  const SceneFile file = read_scene_file(o.scene);
  const std::string where = o.scene.string();
  if (!file.forest) throw_invalid(where, "has no [forest] table", "the trees of the picture");
  if (!file.light) throw_invalid(where, "has no [light] table", "the sun and sky of the picture");
  const auto folder = find_configs(o.configs) / "species";
  return {o.scene.stem().string(), where, [file, folder](const RunControl& control) {
            Forest forest = grow_forest(*file.forest, SpeciesLibrary::load(folder), control, nullptr);
            const Camera camera = file.camera ? *file.camera : default_camera(forest_bounds(forest));
            return ImageTask{std::move(forest), *file.light, camera,
                             image_ways(file.render.value_or(RenderSettings{}))};
          }};
}

std::vector<ImageScene> scenes_of(const BenchOptions& o) {
  if (!o.scene.empty()) return {scene_of(o)};
  return choose_image_scenes(image_scenes(o.seed, find_configs(o.configs) / "species"), o.scenes);
}

void print_notes(const ImageBenchmark& benchmark) {
  std::printf("reference: path-traced, %d samples per pixel in two halves, own noise %.2f %% per pixel",
              benchmark.reference_samples, 100 * benchmark.reference_noise);
  if (!benchmark.light_map_method.empty())
    std::printf("; light map by %s, %s of CPU, not in the times", benchmark.light_map_method.c_str(),
                seconds_text(benchmark.light_map_cpu_s).c_str());
  std::printf("\n\n");
}

void write_outputs(const BenchOptions& o, const std::vector<ImageBenchmark>& all,
                   const MachineFacts& machine) {
  if (!o.csv.empty()) {
    write_whole_file(o.csv, image_csv(all, o.threads, machine));
    std::printf("wrote    %s\n", o.csv.c_str());
  }
  if (!o.plot.empty()) {
    draw_plots(image_page(all, machine), o.plot);
    std::printf("wrote    %s\n", o.plot.c_str());
  }
}

}  // namespace

void run_bench_images(const BenchOptions& o, const RunControl& control) {
  check(o);
  const std::vector<ImageScene> scenes = scenes_of(o);
  choose_image_ways(image_ways({}), o.ways);  // refused before anything grows
  const ImagePlan plan = plan_of(o);
  const MachineFacts machine = machine_facts();
  std::printf("%s, %s, commit %s, %s; medians of %d pictures of other seeds\n", machine.processor.c_str(),
              machine.date_utc.c_str(), machine.commit.c_str(), machine.build_type.c_str(), plan.repeats);
  std::printf("errors in %% of the picture's mean brightness; times with all that a picture prepares\n\n");
  std::vector<ImageBenchmark> all;
  std::vector<std::string> refused;
  for (const ImageScene& scene : scenes) {
    ImageTask task = scene.make(control);
    if (task.ways.empty()) task.ways = image_ways({});
    task.ways = choose_image_ways(task.ways, o.ways);
    all.push_back(image_errors(task, plan, refused, control));
    finish_progress();
    std::fputs(image_table(all.back()).c_str(), stdout);
    print_notes(all.back());
    std::fflush(stdout);
  }
  for (const std::string& line : refused) std::printf("refused  %s\n", line.c_str());
  write_outputs(o, all, machine);
}

}  // namespace sunfleck
