// Head comment in command_options.h: forests, light, pictures and files.
#include <CLI/CLI.hpp>

#include "lighting/plan/light_request.h"
#include "server/apps/command_options.h"

namespace sunfleck {

std::string known_methods() {
  std::string names;
  for (const std::string& name : method_names()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

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

void add_light(CLI::App& app, LightOptions& o) {
  CLI::App* c = app.add_subcommand("light", "Compute the light on every foliage element of a forest");
  c->add_option("forest", o.forest, "Forest (.vdb)")->required();
  c->add_option("--scene", o.scene, "Scene file (TOML) with a [light] table")->required();
  c->add_option("--method", o.method, "Instead of the scene file's: " + known_methods());
  c->add_option("--trees", o.trees,
                "Numbers of the trees to answer for, instead of the scene file's; all shade")
      ->delimiter(',');
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
  c->add_option(
       "--far-light", o.far_light,
       "Path-traced: share of a surface's light that far trees may be left out for (0: none, to 0.5)")
      ->check(CLI::Range(0.0, 0.5));
  c->add_option("--leaf-sun", o.leaf_sun,
                "light_map: sunlight on leaves traced, stored (even over a leaf) or tile (sunflecks without "
                "rays); left out: as the scene file's [render] says")
      ->check(CLI::IsMember({"traced", "stored", "tile"}));
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

}  // namespace sunfleck
