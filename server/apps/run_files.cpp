// info, import and export: files in and out, no light computed.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "lighting/map/light_map_file.h"
#include "lighting/map/stand_netcdf.h"
#include "lighting/render/billboard_export.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/stand_summary.h"
#include "server/apps/summary.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/exchange/attach_leaves.h"
#include "sim/exchange/gltf.h"
#include "sim/exchange/qsm.h"
#include "sim/grid/forest_file.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

constexpr double kFarthest_m = 1e9;  // numbers of ground cells and the like stay in their range

void print_light_file(const std::filesystem::path& path) {
  const LightMap map = load_netcdf(path);
  std::printf("light map    %s (seed %llu, version %s) of forest %s\n", map.provenance.method.c_str(),
              static_cast<unsigned long long>(map.provenance.seed), map.provenance.version.c_str(),
              map.provenance.forest_hash.c_str());
  for (const BandLightMap& band : map.bands)
    std::printf("%-12s %s elements, %s trees, mean irradiance (both faces) %.5g W m-2\n",
                (band.band + ":").c_str(), grouped(band.elements.size()).c_str(),
                grouped(band.trees.size()).c_str(), band.mean_irradiance_w_m2);
  for (const auto& [name, value] : map.provenance.settings)
    std::printf("  %s = %s\n", name.c_str(), value.c_str());
  for (const SkipNote& s : map.provenance.skipped)
    std::printf("skipped      %s: %s\n", s.what.c_str(), s.reason.c_str());
  for (const std::string& note : map.provenance.notes) std::printf("note         %s\n", note.c_str());
}

void print_forest_file(const std::filesystem::path& path) {
  print_forest(load_forest(path));
  for (const GridSummary& g : summarize_forest_file(path))
    std::printf("grid         %-32s %-10s voxel %.3g m, %s active, integral %.6g\n", g.name.c_str(),
                g.type.c_str(), g.voxel_size_m, grouped(g.active_voxels).c_str(), g.integral);
}

std::map<std::string, std::string> read_pairs(const std::vector<std::string>& pairs,
                                              const std::string& option) {
  std::map<std::string, std::string> result;
  for (const std::string& pair : pairs) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos)
      throw_invalid(option, "'" + pair + "' has no '='", option + " FILE_MATERIAL=MATERIAL");
    result[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return result;
}

Prototype read_qsm(const ImportOptions& o, ImportReport& report) {
  QsmReport found;
  Prototype tree = import_qsm(o.file, o.material, &found);
  report.warnings = std::move(found.warnings);
  if (o.leaf_area_m2 == 0.0) {
    report.warnings.push_back("the tree has no leaves: --leaf-area puts some on its twigs");
    return tree;
  }
  const SpeciesLibrary library = SpeciesLibrary::load(find_configs(o.configs) / "species");
  attach_leaves(tree, library.find(o.material, "--material"), {o.leaf_area_m2, o.elements, 1});
  return tree;
}

Prototype read_prototype(const ImportOptions& o, ImportReport& report) {
  std::string format = o.format.empty() ? o.file.extension().string() : "." + o.format;
  if (format == ".obj" || format == ".ply")
    return import_mesh(
        o.file, {read_pairs(o.leaf_materials, "--leaf"), read_pairs(o.wood_materials, "--wood")}, &report);
  if (format == ".leaves" || format == ".txt" || format == ".gz" || format == ".def")
    return import_leaf_list(o.file, o.material, &report);
  if (format == ".csv" || format == ".qsm") return read_qsm(o, report);
  throw_invalid(o.file.string(), "cannot tell the format", "--format leaves, obj, ply or qsm");
}

// x y z [scale azimuth_deg] per line; # comments.
std::vector<Instance> read_instances(const std::filesystem::path& path) {
  std::ifstream in(path);
  if (!in)
    throw Error(ErrorKind::kNotFound, path.string(), "cannot be read", "a text file with x y z per line");
  std::vector<Instance> instances;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));
    std::istringstream fields(line);
    std::vector<double> v;
    for (double x; fields >> x;) v.push_back(x);
    if (v.empty() && fields.eof()) continue;
    if (!fields.eof() || (v.size() != 3 && v.size() != 5))
      throw_invalid(path.string() + ":" + std::to_string(number),
                    "is not 'x y z' or 'x y z scale azimuth_deg'", "three or five numbers");
    if (*std::max_element(v.begin(), v.begin() + 3) > kFarthest_m ||
        *std::min_element(v.begin(), v.begin() + 3) < -kFarthest_m)
      throw_invalid(path.string() + ":" + std::to_string(number), "is further than 1e9 m from the origin",
                    "coordinates in metres");
    Instance instance;
    instance.position_m = {v[0], v[1], v[2]};
    if (v.size() == 5) {
      instance.scale = static_cast<float>(v[3]);
      instance.yaw_rad = static_cast<float>(-radians_from_degrees(v[4]));
    }
    instance.tree.value = static_cast<std::uint32_t>(instances.size());
    instances.push_back(instance);
  }
  if (instances.empty()) throw_invalid(path.string(), "holds no position", "x y z per line");
  return instances;
}

// Every mapping must have met a face: else it names a material the file does not have.
void check_used(const std::vector<std::string>& pairs, const std::string& option,
                const Prototype& prototype) {
  for (const auto& [file_material, material] : read_pairs(pairs, option))
    if (std::find(prototype.materials.begin(), prototype.materials.end(), material) ==
        prototype.materials.end())
      throw_invalid(option, "the file has no face of material '" + file_material + "'",
                    "a material of the file");
}

// A species' optics where the name is one, else a material whose optics the scene file must state.
Material find_material(const std::string& name, const std::filesystem::path& configs) {
  const SpeciesLibrary library = SpeciesLibrary::load(find_configs(configs) / "species");
  for (const Species& s : library.all())
    if (s.latin == name || s.code == name) {
      Material material = s.material;
      material.name = name;
      return material;
    }
  return {name, {}};
}

void export_trees(const Forest& forest, const std::filesystem::path& path) {
  std::ostringstream out;
  out << "id_tree,species,x,y,dbh_cm,h_m,z_m,yaw_rad,scale,prototype,leaf_area_m2\n";
  out.precision(9);
  for (const Instance& i : forest.instances) {
    const Prototype& p = forest.prototypes[i.prototype.value];
    const TreeMeasures m = measure(p);
    const double scale = i.scale;
    out << i.tree.value << ",\"" << (p.materials.empty() ? "" : p.materials[0]) << "\"," << i.position_m.x
        << ',' << i.position_m.y << ',' << 100 * scale * m.dbh_m << ',' << scale * m.height_m << ','
        << i.position_m.z << ',' << i.yaw_rad << ',' << i.scale << ",\"" << p.name << "\","
        << scale * scale * m.leaf_area_m2 << '\n';
  }
  write_whole_file(path, out.str());
}

std::string export_format(const ExportOptions& o) {
  if (!o.format.empty()) return o.format;
  const std::string extension = o.output.extension().string();
  if (extension == ".glb") return "gltf";
  return extension == ".ply" ? "ply" : "obj";
}

const Prototype& chosen_prototype(const Forest& forest, const ExportOptions& o) {
  if (o.prototype >= forest.prototypes.size())
    throw_invalid("--prototype", "there is no prototype " + std::to_string(o.prototype),
                  forest.prototypes.empty() ? "a forest that is not empty"
                                            : "0 to " + std::to_string(forest.prototypes.size() - 1));
  return forest.prototypes[o.prototype];
}

void note_left_out(std::size_t left_out, const char* what) {
  if (left_out > 0) std::printf("note         %s %s and were left out\n", grouped(left_out).c_str(), what);
}

void export_cloud(const Forest& forest, const ExportOptions& o, const RunControl& control) {
  BillboardExportOptions options;
  options.cloud.clusters.planes = o.planes;
  options.atlas_px = o.atlas_px;
  const BillboardExport made = export_billboards(forest, o.prototype, options, o.billboards, control);
  std::printf("billboards   %s leaves on %s planes; cloud %.2f MB; picture %d x %d, a texel is %.1f mm\n",
              grouped(made.leaves).c_str(), grouped(made.planes).c_str(),
              static_cast<double>(made.cloud_bytes) / 1e6, o.atlas_px, o.atlas_px, 1e3 * made.texel_m);
  std::printf("cutoff       alpha %.3f keeps %.1f %% of what leaves cover in the picture\n",
              made.alpha_cutoff, 100 * made.cover_kept);
  std::printf("wrote        %s\n", o.billboards.c_str());
}

void export_whole(const Forest& forest, const std::filesystem::path& path, const RunControl& control) {
  const GltfReport report = export_gltf(forest, path, control);
  std::printf("glTF         %s meshes, %s trees, %s triangles, %.1f MB\n", grouped(report.meshes).c_str(),
              grouped(report.nodes).c_str(), grouped(report.triangles).c_str(),
              static_cast<double>(report.bytes) / 1e6);
}

}  // namespace

void run_info(const InfoOptions& o) {
  if (o.file.extension() == ".nc" && is_stand_netcdf(o.file))
    return print_stand(load_stand_netcdf(o.file), o.file.stem().string());
  if (o.file.extension() == ".nc") return print_light_file(o.file);
  print_forest_file(o.file);
}

void run_import(const ImportOptions& o) {
  check_outputs("import", {{"-o", o.output, ".vdb"}});
  Forest forest;
  forest.name = o.file.stem().string();
  ImportReport report;
  forest.prototypes.push_back(read_prototype(o, report));
  for (const std::string& name : forest.prototypes[0].materials)
    forest.materials.push_back(find_material(name, o.configs));
  check_used(o.leaf_materials, "--leaf", forest.prototypes[0]);
  check_used(o.wood_materials, "--wood", forest.prototypes[0]);
  forest.instances = o.instances.empty() ? std::vector<Instance>(1) : read_instances(o.instances);
  if (!o.period.empty()) forest.period = Period{{o.period[0], o.period[1]}, {o.period[2], o.period[3]}};
  validate(forest);
  save_forest(forest, o.output);
  print_forest(forest);
  for (const std::string& warning : report.warnings) std::printf("warning      %s\n", warning.c_str());
  for (const Material& m : forest.materials)
    if (m.bands.empty())
      std::printf(
          "note         '%s' is no known species: give its optics as [[light.optics]] in the scene file\n",
          m.name.c_str());
  std::printf("wrote        %s\n", o.output.c_str());
}

void run_export(const ExportOptions& o, const RunControl& control) {
  if (o.output.empty() && o.billboards.empty())
    throw_invalid("-o", "is missing", "the file to write, or --billboards with a folder");
  const Forest forest = load_forest(o.forest);
  if (!o.billboards.empty()) return export_cloud(forest, o, control);
  const std::string format = export_format(o);
  if (format == "gltf")
    export_whole(forest, o.output, control);
  else if (format == "trees")
    export_trees(forest, o.output);
  else if (format == "obj")
    export_obj(chosen_prototype(forest, o), o.output);
  else if (format == "ply")
    export_ply(chosen_prototype(forest, o), o.output);
  else if (format == "qsm")
    note_left_out(export_qsm(chosen_prototype(forest, o), o.output), "triangles of wood are no cylinders");
  else
    note_left_out(export_leaf_list(chosen_prototype(forest, o), o.output),
                  "elements are neither discs nor quads");
  std::printf("wrote        %s\n", o.output.c_str());
}

}  // namespace sunfleck
