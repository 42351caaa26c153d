#include "lighting/bench/image_scenes.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lighting/bench/bench_scenes.h"
#include "lighting/bench/error_against_time.h"
#include "lighting/render/camera_config.h"
#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

constexpr double kFirDbhCm = 12;

Camera sized(Camera camera, int width_px, int height_px) {
  camera.width_px = width_px, camera.height_px = height_px;
  return camera;
}

// Stored light by rays where that is quick, else by the grid.
ImageTask task_of(Forest forest, const Camera& camera, std::uint64_t seed, Method method) {
  LightRequest light = bench_light(forest, "PAR");
  light.method = method;
  light.reference.seed = seed;
  light.reference.rays_per_face = light.reference.sun_rays_per_element = 64;
  return {std::move(forest), std::move(light), camera, {}};
}

ImageTask single_tree(const BenchScene& scene, std::uint64_t seed, const RunControl& control) {
  Forest forest = scene.make(control);
  const Camera camera = sized(default_camera(forest_bounds(forest)), 96, 120);
  return task_of(std::move(forest), camera, seed, Method::kReference);
}

ImageTask bush(std::uint64_t seed) {
  Forest forest = generated_crown({.leaves = 1500, .seed = seed});
  forest.name = "bush";
  const Camera camera = sized(default_camera(forest_bounds(forest)), 96, 96);
  return task_of(std::move(forest), camera, seed, Method::kReference);
}

// Adds trees of all prototypes by turns in rows along x, each turned; rows go away along y.
struct Rows {
  int columns = 10, lines = 8;
  double across_m = 1, along_m = 1, first_m = 0;
};
void plant(const Rows& rows, std::uint64_t seed, Forest& forest) {
  forest.instances.clear();
  for (int i = 0; i < rows.columns * rows.lines; ++i) {
    RandomStream random(seed, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    const double x = i % rows.columns - 0.5 * (rows.columns - 1) + random.uniform(-0.2, 0.2);
    const double y = i / rows.columns + random.uniform(-0.2, 0.2);
    Instance tree;
    tree.position_m = {rows.across_m * x, rows.first_m + rows.along_m * y, 0};
    tree.yaw_rad = static_cast<float>(random.uniform(0, 2 * kPi));
    tree.prototype =
        PrototypeId{static_cast<std::uint32_t>(i) % static_cast<std::uint32_t>(forest.prototypes.size())};
    tree.tree = TreeId{static_cast<std::uint32_t>(i + 1)};
    forest.instances.push_back(tree);
  }
}

// A tree of height h at distance d is (160 / 2) / tan(10 degrees) * h / d = 454 h / d pixels high: 127 in
// front, 64 in the last row.
ImageTask firs(std::uint64_t seed, const fs::path& folder, const RunControl& control) {
  const Species& fir = SpeciesLibrary::load(folder).find("Abies alba", "bench");
  Forest forest;
  forest.name = "firs";
  forest.materials = {fir.material};
  for (std::uint64_t variant = 0; variant < 2; ++variant)
    forest.prototypes.push_back(
        grow_prototype(fir, expected_size(fir, kFirDbhCm), seed + variant, 1.0, control));
  const double height_m = prototype_bounds(forest.prototypes[0]).hi.z;
  plant({10, 8, 0.55 * height_m, 3.5 * height_m / 7.0, 3.58 * height_m}, seed, forest);
  Camera camera;
  camera.position_m = {0, 0, 0.8 * height_m};
  camera.look_at_m = {0, 5.0 * height_m, 0.4 * height_m};
  camera.vertical_fov_deg = 20;
  return task_of(std::move(forest), sized(camera, 480, 160), seed, Method::kGrid);
}

// A crown of 2 m at distance d is (96 / 2) / tan(7 degrees) * 2 / d = 780 / d pixels high.
ImageTask far_crowns(std::uint64_t seed) {
  Forest forest = generated_crown({.leaves = 20000, .seed = seed});
  forest.name = "far_crowns";
  plant({20, 20, 2.6, 2.6, 50}, seed, forest);
  Camera camera;
  camera.position_m = {0, 0, 22};
  camera.look_at_m = {0, 70, 2};
  camera.vertical_fov_deg = 14;
  return task_of(std::move(forest), sized(camera, 240, 96), seed, Method::kGrid);
}

std::string known_names(const std::vector<ImageScene>& scenes) {
  std::string known = "all, quick";
  for (const ImageScene& scene : scenes) known += ", " + scene.name;
  return known;
}

}  // namespace

std::vector<ImageScene> image_scenes(std::uint64_t seed, const fs::path& species) {
  const std::vector<BenchScene> trees = choose_scenes(bench_scenes(seed, species), "beech,spruce");
  std::vector<ImageScene> scenes{
      {"bush", "1,500 leaves in a ball", [=](const RunControl&) { return bush(seed); }}};
  for (const BenchScene& tree : trees)
    scenes.push_back(
        {tree.name, tree.what, [=](const RunControl& control) { return single_tree(tree, seed, control); }});
  scenes.push_back({"firs", "80 firs, 64 to 127 pixels high",
                    [=](const RunControl& control) { return firs(seed, species, control); }});
  scenes.push_back({"far_crowns", "400 crowns of 20,000 leaves, 8 to 16 pixels high",
                    [=](const RunControl&) { return far_crowns(seed); }});
  return scenes;
}

std::vector<ImageScene> choose_image_scenes(const std::vector<ImageScene>& scenes, const std::string& names) {
  if (names == "all") return scenes;
  std::vector<ImageScene> chosen;
  std::istringstream in(names == "quick" ? "bush,beech" : names);
  for (std::string name; std::getline(in, name, ',');) {
    const auto found =
        std::find_if(scenes.begin(), scenes.end(), [&](const auto& scene) { return scene.name == name; });
    if (found == scenes.end())
      throw_invalid("--scenes", "there is no scene '" + name + "'", known_names(scenes));
    chosen.push_back(*found);
  }
  if (chosen.empty()) throw_invalid("--scenes", "names no scene", known_names(scenes));
  return chosen;
}

}  // namespace sunfleck
