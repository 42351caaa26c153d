// Head comment in command_options.h: stands of an inventory.
#include <CLI/CLI.hpp>

#include "server/apps/command_options.h"

namespace sunfleck {

void add_stand_files(CLI::App* c, StandFiles& files, const std::string& of) {
  c->add_option("--report", files.report, of + "one page to read in a browser (.html)");
  c->add_option("--pictures", files.pictures, of + "folder for ground map, profile, season, scatter (.png)");
  CLI::Option* geotiff =
      c->add_option("--geotiff", files.geotiff, of + "ground map for geographic information systems (.tif)");
  c->add_option("--epsg", files.epsg,
                of + "number of the projection that the inventory's coordinates are of, for --geotiff")
      ->check(CLI::Range(1024, 32766))
      ->needs(geotiff);
  c->add_option(
      "--photographs", files.photographs,
      of + "folder for a hemispherical photograph per sensor, plain and with the sun's paths (.png)");
  c->add_option("--photograph-px", files.photograph_px, of + "edge of the photographs in pixels")
      ->capture_default_str()
      ->check(CLI::Range(8, 8192));
}

void add_stand(CLI::App& app, StandOptions& o) {
  CLI::App* c = app.add_subcommand(
      "stand", "Light in a stand over a season: trees, ground, layers, sensors; tables, maps and a report");
  c->add_option("scene", o.scene, "Scene file (TOML) with [stand_light] and, without --forest, [forest]")
      ->required();
  c->add_option("--forest", o.forest, "Forest (.vdb) to use instead of growing the scene's");
  c->add_option("--netcdf", o.files.netcdf, "Everything in one file for xarray and R (.nc)");
  c->add_option("--csv", o.files.csv, "Folder for trees.csv, sensors.csv, ground.csv, layers.csv, plot.csv");
  add_stand_files(c, o.files, "");
  c->add_option("--configs", o.configs, "Folder with species/ and grammars/");
  c->footer(
      "Examples:\n  sunfleck stand configs/examples/stand.toml --report report.html\n"
      "  sunfleck stand stand.toml --netcdf light.nc --csv tables --photographs photographs\n"
      "  sunfleck stand stand.toml --geotiff ground.tif --epsg 32632\n"
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

}  // namespace sunfleck
