// What each command of `sunfleck` was asked to do, and the function that does it. Every function throws Error
// for what the user can mend and returns only when it did what was asked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/apps/stand_files.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct GrowOptions {
  std::filesystem::path scene, lsystem, output, configs;
  int steps = -1;                     // -1: what the grammar says
  std::optional<std::uint64_t> seed;  // else 1, or the scene file's
  bool print = false;
};
void run_grow(const GrowOptions& options, const RunControl& control);

struct LightOptions {
  std::filesystem::path forest, scene, netcdf, element_csv, tree_csv;
  std::string method;                // empty: as the scene file says
  std::vector<std::uint32_t> trees;  // the same
  int threads = 0;
};
void run_light(const LightOptions& options, const RunControl& control);

struct RenderOptions {
  std::filesystem::path forest, scene, light_map, png, exr;
  std::string mode, leaf_sun;  // empty: as the scene file says
  double far_light = 0;        // path-traced: share of light that trees left in the file may cost
};
void run_render(const RenderOptions& options, const RunControl& control);

struct StandOptions {
  std::filesystem::path scene, forest, configs;
  StandFiles files;
};
void run_stand(const StandOptions& options, const RunControl& control);

struct InventoryOptions {
  std::filesystem::path file, plot, configs;
};
// Prints every problem; throws Error(kInvalidInput) at the end if there was an error among them.
void run_inventory_check(const InventoryOptions& options);

struct InfoOptions {
  std::filesystem::path file;
};
void run_info(const InfoOptions& options);

struct CalibrateOptions {
  std::filesystem::path scene, csv, configs;
  bool understorey = false;
  int realisations = 4;
};
void run_calibrate(const CalibrateOptions& options, const RunControl& control);

struct ImportOptions {
  std::filesystem::path file, output, configs, instances;
  std::string format;             // leaves, obj, ply, qsm; empty: by extension
  std::string material = "leaf";  // leaf lists, QSM
  double leaf_area_m2 = 0;        // QSM: foliage added on its twigs; 0: none
  int elements = 10'000;
  std::vector<std::string> leaf_materials, wood_materials;  // "file material=forest material"
  std::vector<double> period;                               // x0 y0 size_x size_y, m
};
void run_import(const ImportOptions& options);

struct ExportOptions {
  std::filesystem::path forest, output;
  std::string format;  // obj, ply, gltf, qsm, leaves, trees; empty: by extension
  std::size_t prototype = 0;
  std::filesystem::path billboards;  // a folder; then neither output nor format
  int planes = 260, atlas_px = 2048;
};
void run_export(const ExportOptions& options, const RunControl& control);

struct BenchOptions {
  std::string kind;    // error-vs-time, growth, images, stability, tables
  bool quick = false;  // tables
  std::string scenes = "quick", bands = "PAR,NIR", methods = "all";
  int reference_rays = 256;
  std::size_t most_elements = 1'000'000;  // growth
  std::uint64_t seed = 1;
  int threads = 1;
  int repeats = 3;
  std::filesystem::path csv, plot, configs;
  std::filesystem::path scene;   // images: instead of the built-in ones
  std::string ways = "all";      // images
  std::vector<int> samples;      // images; empty: 1, 4, 16, 64
  int reference_samples = 1024;  // images
};
void run_bench_images(const BenchOptions& options, const RunControl& control);
void run_bench_errors(const BenchOptions& options, const RunControl& control);
void run_bench_stability(const BenchOptions& options, const RunControl& control);
void run_bench_growth(const BenchOptions& options, const RunControl& control);
void run_bench_tables(const BenchOptions& options, const RunControl& control);

struct ServeOptions {
  std::filesystem::path config, configs;
  std::string socket;
};
void run_serve(const ServeOptions& options);

struct ClientOptions {
  std::string action;  // info, create, list, delete, light, stand, render
  std::string address, scene_name;
  std::filesystem::path scene, output, csv, tree_csv, json, png, exr, configs;
  StandFiles stand;                  // but netcdf and csv, which are `output` and `csv` here
  std::string method;                // empty: as the scene file says
  std::vector<std::uint32_t> trees;  // the same
  std::string mode;                  // render; the same
  double stop_after_s = 0;           // render; 0: never
};
void run_client(const ClientOptions& options, const RunControl& control);

}  // namespace sunfleck
