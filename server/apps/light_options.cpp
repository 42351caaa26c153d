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
  c->add_option("--light-map", o.light_map, "Light map of that forest (.nc)")->required();
  c->add_option("--scene", o.scene, "Scene file (TOML) with [light] and, if wanted, [camera]")->required();
  c->add_option("--png", o.png, "Picture to write (.png, sRGB)");
  c->add_option("--exr", o.exr, "Layers to write (.exr: RGB, depth, normal, instance id, irradiance)");
  c->footer(
      "Examples:\n  sunfleck render stand.vdb --light-map light.nc --scene configs/scenes/mixed_stand.toml "
      "--png a.png\n"
      "  sunfleck render stand.vdb --light-map light.nc --scene scene.toml --exr layers.exr");
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

}  // namespace sunfleck
