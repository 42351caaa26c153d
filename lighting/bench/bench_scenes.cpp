#include "lighting/bench/bench_scenes.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

constexpr double kDbhCm = 30;

BenchScene crown_scene(std::string name, std::string what, GeneratedCrown crown) {
  return {name, std::move(what), [name, crown](const RunControl&) {
            Forest forest = generated_crown(crown);
            forest.name = name;
            return forest;
          }};
}

BenchScene tree_scene(std::string name, std::string latin, std::uint64_t seed,
                      const std::filesystem::path& folder) {
  return {name, latin + " of 30 cm DBH from its grammar",
          [name, latin, seed, folder](const RunControl& control) {
            const SpeciesLibrary library = SpeciesLibrary::load(folder);
            const Species& species = library.find(latin, "bench");
            Forest forest;
            forest.name = name;
            forest.materials = {species.material};
            forest.prototypes.push_back(
                grow_prototype(species, expected_size(species, kDbhCm), seed, 1.0, control));
            forest.instances.push_back({});
            return forest;
          }};
}

BenchScene rows_scene(std::string name, std::string what, const CrownRows& rows) {
  return {name, std::move(what), [=](const RunControl&) {
            Forest forest = crowns_in_rows(rows);
            forest.name = name;
            return forest;
          }};
}

std::vector<BenchScene> crown_scenes(std::uint64_t seed) {
  const GeneratedCrown sphere{.kind = CrownKind::kSphere, .leaves = 40000, .seed = seed};
  const auto with = [&](auto change) {
    GeneratedCrown crown = sphere;
    change(crown);
    return crown;
  };
  return {
      crown_scene("sphere_1500", "ball of 1,500 leaves", with([](auto& c) { c.leaves = 1500; })),
      crown_scene("sphere", "ball of 40,000 leaves, crown LAI 5", sphere),
      crown_scene("sphere_100k", "ball of 100,000 leaves", with([](auto& c) { c.leaves = 100000; })),
      crown_scene("sphere_lai1", "crown LAI 1", with([](auto& c) { c.crown_lai = 1; })),
      crown_scene("sphere_lai3", "crown LAI 3", with([](auto& c) { c.crown_lai = 3; })),
      crown_scene("sphere_lai8", "crown LAI 8", with([](auto& c) { c.crown_lai = 8; })),
      crown_scene("planophile", "level leaves", with([](auto& c) { c.angles = LeafAngles::kPlanophile; })),
      crown_scene("erectophile", "upright leaves",
                  with([](auto& c) { c.angles = LeafAngles::kErectophile; })),
      crown_scene("ellipsoid", "twice as high as wide",
                  with([](auto& c) { c.kind = CrownKind::kEllipsoid; })),
      crown_scene("cone", "height twice its base radius", with([](auto& c) { c.kind = CrownKind::kCone; })),
      crown_scene("shell", "leaves in the outer 30 % only",
                  with([](auto& c) { c.kind = CrownKind::kShell; })),
      crown_scene("clumped", "120 clumps in the ball", with([](auto& c) { c.kind = CrownKind::kClumped; }))};
}

std::vector<std::string> split(const std::string& names) {
  std::vector<std::string> parts;
  std::istringstream in(names);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

std::string known_names(const std::vector<BenchScene>& scenes) {
  std::string known = "all, quick";
  for (const BenchScene& scene : scenes) known += ", " + scene.name;
  return known;
}

}  // namespace

Forest crowns_in_rows(const CrownRows& rows) {
  Forest forest = generated_crown(
      {.kind = CrownKind::kClumped, .leaves = rows.leaves, .radius_m = rows.radius_m, .seed = rows.seed});
  const int columns = static_cast<int>(std::ceil(std::sqrt(rows.count)));
  const int lines = (rows.count + columns - 1) / columns;
  forest.instances.clear();
  for (int i = 0; i < rows.count; ++i) {
    RandomStream random(rows.seed, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    Instance instance;
    instance.position_m = Vec3(i % columns + 0.5, i / columns + 0.5, 0) * rows.spacing_m;
    instance.yaw_rad = static_cast<float>(random.uniform(0, 2 * kPi));
    instance.tree = TreeId{static_cast<std::uint32_t>(i + 1)};
    forest.instances.push_back(instance);
  }
  forest.period = Period{{0, 0}, {columns * rows.spacing_m, lines * rows.spacing_m}};
  forest.name = "rows";
  return forest;
}

std::vector<BenchScene> bench_scenes(std::uint64_t seed, const std::filesystem::path& species) {
  std::vector<BenchScene> scenes = crown_scenes(seed);
  scenes.push_back(tree_scene("beech", "Fagus sylvatica", seed, species));
  scenes.push_back(tree_scene("pine", "Pinus sylvestris", seed, species));
  scenes.push_back(tree_scene("spruce", "Picea abies", seed, species));
  scenes.push_back({"layer", "endless layer of LAI 3", [seed](const RunControl&) {
                      return generated_layer({.lai = 3, .leaves = 20000, .seed = seed});
                    }});
  scenes.push_back(rows_scene("canopy", "nine clumped crowns side by side, repeated", {.seed = seed}));
  scenes.push_back(
      rows_scene("hectare", "100 clumped crowns of 5,000 leaves, repeated",
                 {.count = 100, .leaves = 5000, .radius_m = 4.5, .spacing_m = 10, .seed = seed}));
  return scenes;
}

std::vector<BenchScene> choose_scenes(const std::vector<BenchScene>& scenes, const std::string& names) {
  if (names == "all") return scenes;
  std::vector<BenchScene> chosen;
  for (const std::string& name : split(names == "quick" ? "sphere,clumped,beech" : names)) {
    const auto found = std::find_if(scenes.begin(), scenes.end(),
                                    [&](const BenchScene& scene) { return scene.name == name; });
    if (found == scenes.end())
      throw_invalid("--scenes", "there is no scene '" + name + "'", known_names(scenes));
    chosen.push_back(*found);
  }
  if (chosen.empty()) throw_invalid("--scenes", "names no scene", known_names(scenes));
  return chosen;
}

}  // namespace sunfleck
