// Head comment in command_options.h: server and client.
#include <CLI/CLI.hpp>

#include "server/apps/command_options.h"

namespace sunfleck {

namespace {

void add_client_files(CLI::App* c, ClientOptions& o) {
  c->add_option("-o,--output,--netcdf", o.output, "light, stand: everything in one file to write (.nc)");
  c->add_option("--csv", o.csv, "light: table of all elements to write (.csv); stand: folder for tables");
  c->add_option("--tree-csv", o.tree_csv, "light: table of all trees to write (.csv)");
  add_stand_files(c, o.stand, "stand: ");
  c->add_option("--json", o.json, "stand: all tables as they came over the wire (.json)");
  c->add_option("--png", o.png, "render: picture to write (.png)");
  c->add_option("--exr", o.exr, "render: layers to write (.exr)");
}

}  // namespace

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
  c->add_option("--trees", client.trees,
                "light: numbers of the trees to answer for, instead of the scene file's")
      ->delimiter(',');
  c->add_option("--mode", client.mode, "render: light_map or path_traced, instead of the scene file's")
      ->check(CLI::IsMember({"light_map", "path_traced"}));
  c->add_option("--stop-after", client.stop_after_s,
                "render: take the picture as it is after so many seconds of rendering")
      ->check(CLI::Range(0.0, 1e6));
  add_client_files(c, client);
  c->add_option("--configs", client.configs, "Folder with species/ and grammars/");
  c->footer(
      "Examples:\n  sunfleck client info --address unix:/tmp/sunfleck.sock\n"
      "  sunfleck client create --address unix:/tmp/sunfleck.sock --scene-file "
      "configs/scenes/mixed_stand.toml\n"
      "  sunfleck client light --address unix:/tmp/sunfleck.sock --scene scenes/1f3a... --scene-file "
      "configs/scenes/mixed_stand.toml --tree-csv trees.csv\n"
      "  sunfleck client render --address unix:/tmp/sunfleck.sock --scene scenes/1f3a... --scene-file "
      "configs/scenes/forest_day.toml --mode path_traced --png day.png\n"
      "  sunfleck client stand --address unix:/tmp/sunfleck.sock --scene scenes/1f3a... --scene-file "
      "configs/examples/stand.toml --netcdf stand.nc --csv tables --report stand.html");
}

}  // namespace sunfleck
