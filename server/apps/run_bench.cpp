// bench: error against time of every method, growth of its cost, and stability, on scenes made here.
#include <cmath>
#include <cstdio>

#include "lighting/bench/bench_scenes.h"
#include "lighting/bench/benchmark_tables.h"
#include "lighting/bench/cost_growth.h"
#include "lighting/bench/published_tables.h"
#include "lighting/bench/stability.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

void check_range(const char* option, double value, double low, double high, const char* range) {
  if (!(value >= low && value <= high)) throw_invalid(option, "is out of range", range);
}

void check(const BenchOptions& o) {
  check_range("--reference-rays", o.reference_rays, 2, 65536, "2 to 65536");
  check_range("--repeats", o.repeats, 1, 1000, "1 to 1000");
  check_range("--most-elements", static_cast<double>(o.most_elements), 1000, 2e7, "1000 to 20000000");
  std::vector<Output> outputs;
  if (!o.csv.empty()) outputs.push_back({"--csv", o.csv, ".csv"});
  if (!o.plot.empty()) outputs.push_back({"--plot", o.plot, o.plot.extension() == ".png" ? ".png" : ".svg"});
  if (!outputs.empty()) check_outputs("bench", outputs);
}

void say_machine(const MachineFacts& machine, const BenchOptions& o) {
  std::printf("%s, %d thread%s used, %s, commit %s, %s\n", machine.processor.c_str(),
              o.threads == 0 ? machine.threads : o.threads, o.threads == 1 ? "" : "s",
              machine.date_utc.c_str(), machine.commit.c_str(), machine.build_type.c_str());
}

void print_row(const BenchmarkRow& r) {
  std::printf("%-12s %-5s %-19s %-15s %7.1f %7.1f %6.1f %6.1f %7.1f %9s %9s %9s %7.0f MB\n", r.scene.c_str(),
              r.band.c_str(), r.method.c_str(), r.knob.c_str(), 100 * r.error.bias, 100 * r.error.element_rms,
              100 * r.error.cell_rms, 100 * r.error.class_rms, 100 * r.error.diffuse_rms,
              seconds_text(r.wall_s).c_str(), seconds_text(r.cpu_s).c_str(), seconds_text(r.setup_s).c_str(),
              1e-6 * static_cast<double>(r.peak_memory_bytes));
}

void print_head(const BenchOptions& o) {
  std::printf("error in %% of the mean irradiance of an element; times: medians of %d\n", o.repeats);
  std::printf("%-12s %-5s %-19s %-15s %7s %7s %6s %6s %7s %9s %9s %9s %10s\n", "scene", "band", "method",
              "knob", "bias", "element", "cell", "class", "diffuse", "wall", "CPU", "setup", "peak");
}

void write_outputs(const BenchOptions& o, const std::string& csv, const PlotPage& page) {
  if (!o.csv.empty()) {
    write_whole_file(o.csv, csv);
    std::printf("wrote    %s\n", o.csv.c_str());
  }
  if (!o.plot.empty()) {
    draw_plots(page, o.plot);
    std::printf("wrote    %s\n", o.plot.c_str());
  }
}

void print_front(const std::vector<BenchmarkRow>& rows, const std::string& scene, const std::string& band) {
  std::printf("%-12s %-5s front:", scene.c_str(), band.c_str());
  for (const std::size_t i : pareto_front(rows, scene, band))
    std::printf(" %s (%s) %.1f %% in %s;", rows[i].method.c_str(), rows[i].knob.c_str(),
                100 * rows[i].error.element_rms, seconds_text(rows[i].cpu_s).c_str());
  std::printf("\n");
}

}  // namespace

void run_bench_errors(const BenchOptions& o, const RunControl& control) {
  check(o);
  const auto scenes = choose_scenes(bench_scenes(o.seed, find_configs(o.configs) / "species"), o.scenes);
  const BenchmarkPlan plan{o.reference_rays, o.repeats, {o.threads}, method_ladders(o.methods)};
  const MachineFacts machine = machine_facts();
  say_machine(machine, o);
  print_head(o);
  std::vector<BenchmarkRow> all;
  std::vector<std::string> refused;
  for (const BenchScene& scene : scenes) {
    const Forest forest = scene.make(control);
    LightRequest request = bench_light(forest, o.bands);
    request.reference.seed = o.seed;
    const auto rows = error_against_time(forest, request, plan, refused, control);
    finish_progress();
    for (const BenchmarkRow& row : rows) print_row(row);
    for (const std::string& band : request.optics.bands) print_front(rows, forest.name, band);
    if (!rows.empty())
      std::printf("%-12s truth: %d rays per face, own noise %.1f %% per element\n", forest.name.c_str(),
                  o.reference_rays, 100 * rows.front().truth_noise);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  for (const std::string& line : refused) std::printf("refused  %s\n", line.c_str());
  std::printf("what the papers say of themselves: sunfleck bench tables\n");
  write_outputs(o, benchmark_csv(all, o.threads, machine), pareto_page(all, machine));
}

void run_bench_growth(const BenchOptions& o, const RunControl& control) {
  check(o);
  const GrowthPlan plan{.steps = method_ladders(o.methods),
                        .most_elements = o.most_elements,
                        .repeats = o.repeats,
                        .cost = {o.threads},
                        .seed = o.seed};
  const MachineFacts machine = machine_facts();
  say_machine(machine, o);
  std::printf("%-10s %9s %-19s %-15s %9s %9s  %-24s %s\n", "growing", "count", "method", "knob", "wall",
              "CPU", "bias % [95 % interval]", "RMS per element %");
  std::vector<GrowthRow> all;
  for (const GrowthKind kind :
       {GrowthKind::kLeaves, GrowthKind::kInstances, GrowthKind::kBands, GrowthKind::kSuns}) {
    const auto rows = cost_growth(kind, plan, control);
    finish_progress();
    for (const GrowthRow& r : rows)
      std::printf("%-10s %9.0f %-19s %-15s %9s %9s  %6.1f [%5.1f, %5.1f]     %.1f [%.1f, %.1f]\n",
                  to_string(kind).c_str(), r.count, r.method.c_str(), r.knob.c_str(),
                  seconds_text(r.wall_s).c_str(), seconds_text(r.cpu_s).c_str(), 100 * r.bias,
                  100 * r.bias_low, 100 * r.bias_high, 100 * r.element_rms, 100 * r.element_rms_low,
                  100 * r.element_rms_high);
    for (const MethodStep& step : plan.steps) {
      const double p =
          growth_exponent(rows, to_string(step.method), step.knob, kind == GrowthKind::kLeaves ? 1e4 : 1);
      if (std::isfinite(p))
        std::printf("%-10s exponent of %s (%s): %.2f\n", to_string(kind).c_str(),
                    to_string(step.method).c_str(), step.knob.c_str(), p);
    }
    all.insert(all.end(), rows.begin(), rows.end());
  }
  write_outputs(o, growth_csv(all, o.threads, machine), growth_page(all, machine));
}

void run_bench_stability(const BenchOptions& o, const RunControl& control) {
  if (!o.csv.empty()) check_outputs("bench stability", {{"--csv", o.csv, ".csv"}});
  const std::vector<SceneStability> scenes = run_stability(control);
  finish_progress();
  const std::vector<StabilityRow> forms = closed_form_rows();
  std::fputs(stability_table(scenes, forms).c_str(), stdout);
  if (o.csv.empty()) return;
  write_whole_file(o.csv, stability_csv(scenes) + "\n" + stability_csv(forms));
  std::printf("wrote    %s\n", o.csv.c_str());
}

void run_bench_tables(const BenchOptions& o, const RunControl& control) {
  check(o);
  const MachineFacts machine = machine_facts();
  say_machine(machine, o);
  const std::vector<PublishedTable> tables =
      run_published_tables({o.quick, o.threads, o.repeats, o.seed}, control);
  finish_progress();
  std::printf("%s", published_text(tables).c_str());
  if (o.csv.empty()) return;
  write_whole_file(o.csv, published_csv(tables, o.threads, machine));
  std::printf("wrote    %s\n", o.csv.c_str());
}

}  // namespace sunfleck
