// sunfleck: the command line. Says what can be asked and hands each request on; computes nothing.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "lighting/plan/light_request.h"
#include "server/apps/commands.h"
#include "server/apps/terminal.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

void add_grow(CLI::App& app, GrowOptions& o) {
  CLI::App* c =
      app.add_subcommand("grow", "Grow a forest, or a single plant from an L-system, into a .vdb file");
  c->add_option("scene", o.scene, "Scene file (TOML) with a [forest] table");
  c->add_option("--lsystem", o.lsystem, "L-system grammar (.lsys) to grow instead of a scene");
  c->add_option("-o,--output", o.output, "File to write: .vdb");
  c->add_option("--steps", o.steps, "Derivation steps; default: what the grammar says")
      ->check(CLI::Range(0, 1000000));
  c->add_option("--seed", o.seed, "Seed, instead of 1 or the scene file's")->check(CLI::NonNegativeNumber);
  c->add_flag("--print", o.print, "Print the derived string of an L-system");
  c->add_option("--configs", o.configs, "Folder with species/ and grammars/");
  c->footer(
      "Examples:\n  sunfleck grow configs/scenes/mixed_stand.toml -o stand.vdb\n"
      "  sunfleck grow --lsystem configs/grammars/fagus_sylvatica.lsys --seed 7 -o beech.vdb\n"
      "  sunfleck grow --lsystem koch.lsys --steps 3 --print");
}

void add_calibrate(CLI::App& app, CalibrateOptions& o) {
  CLI::App* c =
      app.add_subcommand("calibrate", "Estimate the leaf area that explains light measured at sensors");
  c->add_option("scene", o.scene,
                "Scene file (TOML) with [forest] and [stand_light]; sensors with a column pacl")
      ->required();
  c->add_flag("--understorey", o.understorey, "Estimate the number of understorey trees too");
  c->add_option("--realisations", o.realisations, "Stands per run that agree with the inventory")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  c->add_option("--csv", o.csv, "Table of the sensors to write (.csv)");
  c->add_option("--configs", o.configs, "Folder with species/ and grammars/");
  c->footer(
      "Examples:\n  sunfleck calibrate stand.toml\n  sunfleck calibrate stand.toml --understorey --csv "
      "fit.csv");
}

std::string known_methods() {
  std::string names;
  for (const std::string& name : method_names()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

void add_light(CLI::App& app, LightOptions& o) {
  CLI::App* c = app.add_subcommand("light", "Compute the light on every foliage element of a forest");
  c->add_option("forest", o.forest, "Forest (.vdb)")->required();
  c->add_option("--scene", o.scene, "Scene file (TOML) with a [light] table")->required();
  c->add_option("--method", o.method, "Instead of the scene file's: " + known_methods());
  c->add_option("-o,--output", o.netcdf, "Light map to write (.nc)");
  c->add_option("--csv", o.element_csv, "Table of all elements to write (.csv)");
  c->add_option("--tree-csv", o.tree_csv, "Table of all trees to write (.csv)");
  c->add_option("--threads", o.threads, "Threads; 0: all cores. The answer is the same for any number")
      ->check(CLI::Range(0, 4096));
  c->footer(
      "Examples:\n  sunfleck light stand.vdb --scene configs/scenes/mixed_stand.toml -o light.nc --tree-csv "
      "trees.csv\n"
      "  sunfleck light stand.vdb --scene scene.toml --method spp_g -o fast.nc");
}

void add_render(CLI::App& app, RenderOptions& o) {
  CLI::App* c = app.add_subcommand("render", "Make an image of a lit forest");
  c->add_option("forest", o.forest, "Forest (.vdb)")->required();
  c->add_option("--light-map", o.light_map, "Light map of that forest (.nc); path-traced pictures need none");
  c->add_option("--scene", o.scene, "Scene file (TOML) with [light] and, if wanted, [camera]")->required();
  c->add_option("--mode", o.mode, "light_map or path_traced; left out: as the scene file's [render] says");
  c->add_option("--png", o.png, "Picture to write (.png, sRGB)");
  c->add_option("--exr", o.exr,
                "Layers to write (.exr: RGB, depth, normal, instance id, irradiance, standard error)");
  c->footer(
      "Examples:\n  sunfleck render stand.vdb --light-map light.nc --scene configs/scenes/mixed_stand.toml "
      "--png a.png\n"
      "  sunfleck render stand.vdb --light-map light.nc --scene scene.toml --exr layers.exr\n"
      "  sunfleck render stand.vdb --scene scene.toml --mode path_traced --png traced.png\n"
      "Ctrl-C keeps what a path-traced picture has so far.");
}

void add_stand(CLI::App& app, StandOptions& o) {
  CLI::App* c = app.add_subcommand(
      "stand", "Light in a stand over a season: trees, ground, layers, sensors; tables, maps and a report");
  c->add_option("scene", o.scene, "Scene file (TOML) with [stand_light] and, without --forest, [forest]")
      ->required();
  c->add_option("--forest", o.forest, "Forest (.vdb) to use instead of growing the scene's");
  c->add_option("--netcdf", o.netcdf, "Everything in one file for xarray and R (.nc)");
  c->add_option("--csv", o.csv, "Folder for trees.csv, sensors.csv, ground.csv, layers.csv, plot.csv");
  c->add_option("--report", o.report, "One page to read in a browser (.html)");
  c->add_option("--pictures", o.pictures, "Folder for ground map, profile, season, scatter (.png)");
  c->add_option("--photographs", o.photographs, "Folder for a hemispherical photograph per sensor (.png)");
  c->add_option("--photograph-px", o.photograph_px, "Edge of the photographs in pixels")
      ->capture_default_str()
      ->check(CLI::Range(8, 8192));
  c->add_option("--configs", o.configs, "Folder with species/ and grammars/");
  c->footer(
      "Examples:\n  sunfleck stand configs/examples/stand.toml --report report.html\n"
      "  sunfleck stand stand.toml --netcdf light.nc --csv tables --photographs photographs\n"
      "  sunfleck stand stand.toml --forest stand.vdb --netcdf light.nc");
}

void add_inventory(CLI::App& app, InventoryOptions& o) {
  CLI::App* inventory = app.add_subcommand("inventory", "Look at an inventory before anything runs");
  inventory->require_subcommand(1);
  CLI::App* c = inventory->add_subcommand("check", "List every problem of a tree table with row and remedy");
  c->add_option("file", o.file, "Tree table (CSV)")->required();
  c->add_option("--plot", o.plot, "Outline of the plot (CSV with columns x, y): names trees outside");
  c->add_option("--configs", o.configs, "Folder with species/");
  const char* examples =
      "Examples:\n  sunfleck inventory check trees.csv\n"
      "  sunfleck inventory check trees.csv --plot plot_polygon.csv\n"
      "Exit code: 0 nothing or only warnings, 2 errors.";
  inventory->footer(examples);
  c->footer(examples);
}

void add_files(CLI::App& app, InfoOptions& info, ImportOptions& in, ExportOptions& out) {
  CLI::App* c = app.add_subcommand("info", "Say what is in a forest (.vdb), light map or stand study (.nc)");
  c->add_option("file", info.file, "File to describe")->required();
  c->footer("Examples:\n  sunfleck info stand.vdb\n  sunfleck info light.nc");

  c = app.add_subcommand("import", "Turn a leaf list or a mesh into a forest of one prototype");
  c->add_option("file", in.file, "Leaf list (radius x y z nx ny nz per line; .gz too), .obj or .ply")
      ->required();
  c->add_option("-o,--output", in.output, "Forest to write (.vdb)")->required();
  c->add_option("--format", in.format, "leaves, obj or ply; default: by extension");
  c->add_option("--material", in.material, "Material of a leaf list: a species, or any name")
      ->capture_default_str();
  c->add_option("--leaf", in.leaf_materials, "FILE_MATERIAL=MATERIAL that is two-sided leaf; repeatable");
  c->add_option("--wood", in.wood_materials, "FILE_MATERIAL=MATERIAL that is opaque wood; repeatable");
  c->add_option("--instances", in.instances,
                "Positions: x y z [scale azimuth_deg] per line; default: one at 0 0 0");
  c->add_option("--period", in.period, "Repeat the scene: X0 Y0 SIZE_X SIZE_Y in metres")->expected(4);
  c->add_option("--configs", in.configs, "Folder with species/");
  c->footer(
      "Examples:\n  sunfleck import crown_discs.txt.gz --instances centres.txt --period -50 -50 100 100 -o "
      "het01.vdb\n"
      "  sunfleck import oak.obj --leaf leaves=\"Quercus robur\" --wood bark=\"Quercus robur\" -o oak.vdb");

  c = app.add_subcommand("export", "Write a prototype or the tree list of a forest in a format others read");
  c->add_option("forest", out.forest, "Forest (.vdb)")->required();
  c->add_option("-o,--output", out.output, "File to write")->required();
  c->add_option("--format", out.format, "obj, leaves (leaf list) or trees (CSV)")
      ->capture_default_str()
      ->check(CLI::IsMember({"obj", "leaves", "trees"}));
  c->add_option("--prototype", out.prototype, "Number of the prototype, from 0")->capture_default_str();
  c->footer(
      "Examples:\n  sunfleck export stand.vdb --prototype 2 -o beech.obj\n"
      "  sunfleck export stand.vdb --format trees -o trees.csv");
}

void add_service(CLI::App& app, ServeOptions& serve, ClientOptions& client) {
  CLI::App* c = app.add_subcommand("serve", "Answer requests over gRPC");
  c->add_option("--config", serve.config, "Server settings; default: configs/server.toml");
  c->add_option("--socket", serve.socket, "Unix socket to listen on, instead of the configured addresses");
  c->add_option("--configs", serve.configs, "Folder with species/ and grammars/");
  c->footer("Examples:\n  sunfleck serve\n  sunfleck serve --socket /run/user/1000/sunfleck.sock");

  c = app.add_subcommand("client", "Ask a server for what the other commands do");
  c->add_option("action", client.action, "info, create, list, delete, light, stand or render")
      ->required()
      ->check(CLI::IsMember({"info", "create", "list", "delete", "light", "stand", "render"}));
  c->add_option("--address", client.address, "unix:PATH or HOST:PORT")->required();
  c->add_option("--scene-file", client.scene, "Scene file (TOML)");
  c->add_option("--scene", client.scene_name, "Name the server gave a scene: scenes/...");
  c->add_option("--method", client.method, "Instead of the scene file's: " + known_methods());
  c->add_option("-o,--output", client.netcdf, "Light map to write (.nc)");
  c->add_option("--csv", client.element_csv, "Table of all elements to write (.csv)");
  c->add_option("--tree-csv", client.tree_csv, "Table of all trees to write (.csv)");
  c->add_option("--json", client.json, "Stand light to write, all tables (.json)");
  c->add_option("--png", client.png, "Picture to write (.png)");
  c->add_option("--exr", client.exr, "Layers to write (.exr)");
  c->add_option("--configs", client.configs, "Folder with species/ and grammars/");
  c->footer(
      "Examples:\n  sunfleck client info --address unix:/tmp/sunfleck.sock\n"
      "  sunfleck client create --address unix:/tmp/sunfleck.sock --scene-file "
      "configs/scenes/mixed_stand.toml\n"
      "  sunfleck client light --address unix:/tmp/sunfleck.sock --scene scenes/1f3a... --scene-file "
      "configs/scenes/mixed_stand.toml --tree-csv trees.csv");
}

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
  CLI::App* stability =
      bench->add_subcommand("stability", "Every method at the limits of physics and arithmetic");
  stability->add_option("--csv", o.csv, "Tables to write (.csv)");
  CLI::App* tables = bench->add_subcommand("tables", "The papers' own figures, ours beside them");
  add_bench_tables(tables, o);
  for (CLI::App* c : {errors, growth, stability, tables}) c->callback([&o, c] { o.kind = c->get_name(); });
  bench->footer(
      "Examples:\n  sunfleck bench error-vs-time --scenes sphere --bands PAR\n  sunfleck bench error-vs-time "
      "--scenes all --csv errors.csv --plot errors.svg\n  sunfleck bench growth --methods grid,auto --plot "
      "growth.png");
}

void run_bench(const BenchOptions& o, const RunControl& control) {
  if (o.kind == "growth") return run_bench_growth(o, control);
  if (o.kind == "stability") return run_bench_stability(o, control);
  if (o.kind == "tables") return run_bench_tables(o, control);
  run_bench_errors(o, control);
}

bool has_command(const CLI::App& app, const std::string& name) {
  for (const CLI::App* c : app.get_subcommands({}))
    if (c->get_name() == name) return true;
  return false;
}

int refuse_command(const CLI::App& app, const char* command) {
  std::string known;
  for (const CLI::App* c : app.get_subcommands({})) known += (known.empty() ? "" : ", ") + c->get_name();
  std::fprintf(stderr, "sunfleck: there is no command '%s' (one of %s)\n", command, known.c_str());
  return 2;
}

int run(int argc, char** argv) {
  CLI::App app{"Sunfleck grows forests and tells how much light every leaf in them gets."};
  app.set_version_flag("--version", std::string("sunfleck ") + kVersion + " (" + kBuildType + ")");
  app.require_subcommand(1);
  GrowOptions grow;
  LightOptions light;
  RenderOptions render;
  StandOptions stand;
  InventoryOptions inventory;
  InfoOptions info;
  ImportOptions import_options;
  ExportOptions export_options;
  ServeOptions serve;
  ClientOptions client;
  BenchOptions bench;
  CalibrateOptions calibrate_options;
  add_calibrate(app, calibrate_options);
  add_grow(app, grow);
  add_light(app, light);
  add_render(app, render);
  add_stand(app, stand);
  add_inventory(app, inventory);
  add_service(app, serve, client);
  add_files(app, info, import_options, export_options);
  add_bench(app, bench);
  if (argc > 1 && argv[1][0] != '-' && !has_command(app, argv[1])) return refuse_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const std::string command = app.get_subcommands().front()->get_name();
  return run_and_report([&] {
    if (command == "serve") return run_serve(serve);
    const RunControl control = terminal_control();
    if (command == "grow") return run_grow(grow, control);
    if (command == "light") return run_light(light, control);
    if (command == "calibrate") return run_calibrate(calibrate_options, control);
    if (command == "render") return run_render(render, control);
    if (command == "stand") return run_stand(stand, control);
    if (command == "inventory") return run_inventory_check(inventory);
    if (command == "info") return run_info(info);
    if (command == "import") return run_import(import_options);
    if (command == "export") return run_export(export_options);
    if (command == "client") return run_client(client, control);
    return run_bench(bench, control);
  });
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) { return sunfleck::run(argc, argv); }
