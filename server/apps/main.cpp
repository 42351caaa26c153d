// sunfleck: the command line. Hands each request on; computes nothing.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "server/apps/command_options.h"
#include "server/apps/terminal.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

void run_bench(const BenchOptions& o, const RunControl& control) {
  if (o.kind == "growth") return run_bench_growth(o, control);
  if (o.kind == "images") return run_bench_images(o, control);
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
    if (command == "export") return run_export(export_options, control);
    if (command == "client") return run_client(client, control);
    return run_bench(bench, control);
  });
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) { return sunfleck::run(argc, argv); }
