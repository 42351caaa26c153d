// Head comment in command_options.h: measuring.
#include <CLI/CLI.hpp>

#include "server/apps/command_options.h"

namespace sunfleck {

namespace {

void add_bench_common(CLI::App* c, BenchOptions& o) {
  c->add_option("--methods", o.methods, "Names separated by commas, or all")->capture_default_str();
  c->add_option("--seed", o.seed, "Seed of the scenes")->capture_default_str()->check(CLI::NonNegativeNumber);
  c->add_option("--repeats", o.repeats, "Timed runs; the median is printed")->capture_default_str();
  c->add_option("--threads", o.threads, "Threads; 0: all cores")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096));
  c->add_option("--csv", o.csv, "Table to write (.csv)");
  c->add_option("--plot", o.plot, "Plots to draw (.svg or .png)");
}

void add_bench_tables(CLI::App* c, BenchOptions& o) {
  c->add_flag("--quick", o.quick, "Small scenes and few rays: to try it, not to quote");
  c->add_option("--seed", o.seed, "Seed of the scenes")->capture_default_str()->check(CLI::NonNegativeNumber);
  c->add_option("--repeats", o.repeats, "Timed runs; the median is printed")->capture_default_str();
  c->add_option("--threads", o.threads, "Threads; 0: all cores")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096));
  c->add_option("--csv", o.csv, "Table to write (.csv)");
}

void add_bench_images(CLI::App* c, BenchOptions& o) {
  const auto scene = c->add_option("--scene", o.scene, "Scene file with [forest], [light] and [camera]");
  c->add_option("--scenes", o.scenes, "Built-in ones: bush, beech, spruce, firs, far_crowns, quick, or all")
      ->capture_default_str()
      ->excludes(scene);
  c->add_option("--ways", o.ways, "Names separated by commas, or all; path_traced always comes along")
      ->capture_default_str();
  c->add_option("--samples", o.samples, "Per pixel, rising, separated by commas (1,4,16,64)")->delimiter(',');
  c->add_option("--reference-samples", o.reference_samples, "Per pixel, of both halves of the truth")
      ->capture_default_str();
  c->add_option("--seed", o.seed, "Seed of the scenes and pictures")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  c->add_option("--repeats", o.repeats, "Timed pictures of other seeds; the median is printed")
      ->capture_default_str();
  c->add_option("--threads", o.threads, "Threads; 0: all cores")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096));
  c->add_option("--configs", o.configs, "Folder with species/ and grammars/");
  c->add_option("--csv", o.csv, "Table to write (.csv)");
  c->add_option("--plot", o.plot, "Plots to draw (.svg or .png)");
}

}  // namespace

void add_bench(CLI::App& app, BenchOptions& o) {
  CLI::App* bench = app.add_subcommand("bench", "Measure methods on generated scenes");
  bench->require_subcommand(1);
  CLI::App* errors =
      bench->add_subcommand("error-vs-time", "Error and time of every method, measured together");
  errors->add_option("--scenes", o.scenes, "Names separated by commas, quick, or all")->capture_default_str();
  errors->add_option("--bands", o.bands, "PAR, NIR, VIS, WHITE, separated by commas, or all")
      ->capture_default_str();
  errors->add_option("--reference-rays", o.reference_rays, "Rays per face of the truth")
      ->capture_default_str();
  errors->add_option("--configs", o.configs, "Folder with species/ and grammars/");
  add_bench_common(errors, o);
  CLI::App* growth = bench->add_subcommand("growth", "Cost of every method as the scene grows");
  growth->add_option("--most-elements", o.most_elements, "Leave larger scenes out")->capture_default_str();
  add_bench_common(growth, o);
  CLI::App* images =
      bench->add_subcommand("images", "Error and time of every way to a picture against its samples");
  add_bench_images(images, o);
  CLI::App* stability =
      bench->add_subcommand("stability", "Every method at the limits of physics and arithmetic");
  stability->add_option("--csv", o.csv, "Tables to write (.csv)");
  CLI::App* tables = bench->add_subcommand("tables", "The papers' own figures, ours beside them");
  add_bench_tables(tables, o);
  for (CLI::App* c : {errors, growth, images, stability, tables})
    c->callback([&o, c] { o.kind = c->get_name(); });
  bench->footer(
      "Examples:\n  sunfleck bench error-vs-time --scenes sphere --bands PAR\n  sunfleck bench error-vs-time "
      "--scenes all --csv errors.csv --plot errors.svg\n  sunfleck bench growth --methods grid,auto --plot "
      "growth.png\n  sunfleck bench images --scenes beech --samples 1,4,16 --plot pictures.svg");
}

}  // namespace sunfleck
