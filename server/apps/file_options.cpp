// Options of info, import and export.
#include <CLI/CLI.hpp>

#include "server/apps/command_options.h"

namespace sunfleck {

void add_files(CLI::App& app, InfoOptions& info, ImportOptions& in, ExportOptions& out) {
  CLI::App* c = app.add_subcommand("info", "Say what is in a forest (.vdb), light map or stand study (.nc)");
  c->add_option("file", info.file, "File to describe")->required();
  c->footer("Examples:\n  sunfleck info stand.vdb\n  sunfleck info light.nc");

  c = app.add_subcommand("import",
                         "Turn a leaf list, a mesh or a scanned tree into a forest of one prototype");
  c->add_option(
       "file", in.file,
       "Leaf list (radius x y z nx ny nz per line; .gz too), .obj, .ply, or .csv with the cylinders of a "
       "quantitative structure model (start, end or axis and length, radius; metres)")
      ->required();
  c->add_option("-o,--output", in.output, "Forest to write (.vdb)")->required();
  c->add_option("--format", in.format, "leaves, obj, ply or qsm; default: by extension")
      ->check(CLI::IsMember({"leaves", "obj", "ply", "qsm"}));
  c->add_option("--material", in.material, "Material of a leaf list or QSM: a species, or any name")
      ->capture_default_str();
  c->add_option("--leaf-area", in.leaf_area_m2,
                "QSM: put this leaf area (m2, one-sided) of the species on the twigs; default: none");
  c->add_option("--elements", in.elements, "QSM: number of leaves or shoots for --leaf-area")
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
      "  sunfleck import oak.obj --leaf leaves=\"Quercus robur\" --wood bark=\"Quercus robur\" -o oak.vdb\n"
      "  sunfleck import scan.csv --material \"Fagus sylvatica\" --leaf-area 180 -o beech.vdb");

  c = app.add_subcommand("export", "Write a forest, a prototype or the tree list in a format others read");
  c->add_option("forest", out.forest, "Forest (.vdb)")->required();
  CLI::Option* output = c->add_option("-o,--output", out.output, "File to write");
  c->add_option("--format", out.format,
                "gltf (all trees, instanced), obj, ply, qsm (cylinders, CSV) or leaves (leaf list) of one "
                "prototype, or "
                "trees (CSV); default: by extension .glb, .obj, .ply, else obj")
      ->check(CLI::IsMember({"gltf", "obj", "ply", "qsm", "leaves", "trees"}));
  c->add_option("--prototype", out.prototype, "Number of the prototype, from 0")->capture_default_str();
  c->add_option(
       "--billboards", out.billboards,
       "Folder: the prototype's foliage as textured planes for real-time viewers, glTF with PNG, and the "
       "hash, list and leaf textures with their description")
      ->excludes(output);
  c->add_option("--planes", out.planes, "Billboards: how many planes, 1 to 4096")->capture_default_str();
  c->add_option("--atlas", out.atlas_px, "Billboards: side of the picture in texels")->capture_default_str();
  c->footer(
      "Examples:\n  sunfleck export stand.vdb --prototype 2 -o beech.obj\n"
      "  sunfleck export stand.vdb -o stand.glb\n"
      "  sunfleck export stand.vdb --format qsm --prototype 0 -o cylinders.csv\n"
      "  sunfleck export stand.vdb --format trees -o trees.csv\n"
      "  sunfleck export stand.vdb --prototype 2 --billboards beech");
}

}  // namespace sunfleck
