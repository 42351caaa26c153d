// See stability_scenes.h.
#include "lighting/bench/stability_scenes.h"

#include <cmath>
#include <limits>

#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {

namespace {

constexpr double kBeam = 500, kDiffuse = 100;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kSun(0.3, -0.5, 0.6);

FoliageElement square_leaf(const Vec3& centre_m, const Vec3& normal, double side_m) {
  const Basis basis = basis_around(glm::normalize(normal));
  FoliageElement e;
  e.centre_m = centre_m;
  e.half_u_m = 0.5 * side_m * basis.tangent;
  e.half_v_m = 0.5 * side_m * basis.bitangent;
  e.area_m2 = static_cast<float>(side_m * side_m);
  return e;
}

LitForest lit(Forest forest, const Vec3& to_sun = kSun, double beam = kBeam, double diffuse = kDiffuse,
              double soil = 0.2) {
  LitForest result{.forest = std::move(forest), .optics = {}, .light = {}};
  result.optics.bands = {"VIS"};
  result.optics.soil_albedo = {soil};
  result.light.to_sun = to_sun;
  result.light.bands = {{beam, diffuse}};
  return result;
}

LitForest with_leaves(LitForest scene, const LeafOptics& leaf) {
  scene.optics.overrides = {{"*", "VIS", {leaf, 0.0}}};
  return scene;
}

Forest crown(double lai, float scale = 1.0f) {
  Forest forest = generated_crown({.leaves = 400, .crown_lai = lai, .seed = 3});
  forest.instances[0].scale = scale;
  return forest;
}

Forest moved(Forest forest, const Vec3& by_m) {
  forest.instances[0].position_m += by_m;
  forest.terrain.elevation_m += by_m.z;
  return forest;
}

Forest turned(Forest forest) {
  forest.instances[0].yaw_rad += static_cast<float>(kPi / 2);
  return forest;
}

Forest of_leaves(std::vector<FoliageElement> leaves) {
  Forest forest = crown(1);
  forest.prototypes[0].foliage = std::move(leaves);
  return forest;
}

Forest flat_crown() {
  std::vector<FoliageElement> leaves;
  for (int i = 0; i < 400; ++i) {
    RandomStream r(1, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    leaves.push_back(square_leaf({r.uniform(-1, 1), r.uniform(-1, 1), 1.0}, {0, 0, 1}, 0.1));
  }
  return of_leaves(std::move(leaves));
}

// Collects scenes.
class List {
 public:
  void safe(std::string name, LitForest scene) { add(std::move(name), std::move(scene)); }

  void refused(std::string name, LitForest scene) { add(std::move(name), std::move(scene)).refuse = true; }

  void known(std::string name, LitForest scene, std::string figure,
             std::function<double(const LightMap&)> value, double expected, double light_there_is,
             double allowed) {
    StabilityScene& s = add(std::move(name), std::move(scene));
    s.figure = std::move(figure);
    s.value = std::move(value);
    s.known = expected;
    s.light_there_is = light_there_is;
    s.allowed = allowed;
  }

  void same(std::string name, LitForest scene, LitForest twin, double allowed) {
    StabilityScene& s = add(std::move(name), std::move(scene));
    s.figure = "mean light";
    s.value = mean_light;
    s.twin = std::move(twin);
    s.allowed = allowed;
  }

  std::vector<StabilityScene> scenes;

 private:
  StabilityScene& add(std::string name, LitForest scene) {
    StabilityScene& s = scenes.emplace_back();
    s.name = std::move(name);
    s.lit = std::move(scene);
    return s;
  }
};

const auto direct = [](const LightMap& map) { return mean_part(map, &FaceLight::direct_w_m2); };
const auto scattered = [](const LightMap& map) { return mean_part(map, &FaceLight::scattered_w_m2); };

void add_depths(List& list) {
  // Leaves that shade nothing under an even sky over black ground: both faces together get all of it, however
  // they hang. Sectors and rays keep that to within their own weights.
  list.known("optical depth 1e-9", lit(crown(1e-9), kSun, 0, kDiffuse, 0), "sky on both faces", mean_light,
             kDiffuse, kDiffuse, 0.03);
  for (const double lai : {1.0, 30.0, 1e3, 1e6}) {
    char name[40];
    std::snprintf(name, sizeof name, "optical depth %g", lai);
    list.safe(name, lit(crown(lai)));
  }
  list.safe("repeating layer of depth 50", lit(generated_layer({.lai = 100, .leaves = 400})));
  list.safe("repeating layer of depth 0.01", lit(generated_layer({.lai = 0.02, .leaves = 50})));
}

void add_albedos(List& list) {
  const LeafOptics black{}, white{0.5, 0.5, 0.5, 0.5}, mirror{1, 0, 0, 1}, faint{1e-12, 1e-12, 1e-300, 0};
  list.known("albedo 0, black ground", with_leaves(lit(crown(3), kSun, kBeam, kDiffuse, 0), black),
             "scattered light", scattered, 0, kDiffuse, 1e-12);
  list.safe("albedo 0", with_leaves(lit(crown(3)), black));
  list.known(
      "albedo 1", with_leaves(lit(crown(3), kSun, kBeam, kDiffuse, 1), white), "absorbed by leaves, W",
      [](const LightMap& map) { return map.bands[0].trees[0].absorbed_w; }, 0, kDiffuse, 1e-6);
  list.safe("mirror and glass", with_leaves(lit(crown(3)), mirror));
  list.safe("albedo 1e-12", with_leaves(lit(crown(3)), faint));
  list.safe("albedo 1 in a closed canopy",
            with_leaves(lit(generated_layer({.lai = 6, .leaves = 400}), kSun, kBeam, kDiffuse, 1), white));
}

void add_suns(List& list) {
  const LitForest night = lit(crown(3), {1, 0.2, -0.5});
  list.same("sun at elevation 0", lit(crown(3), {1, 0.2, 0}), night, 1e-12);
  list.same("sun at elevation -1e-9", lit(crown(3), {1, 0.2, -1e-9}), night, 1e-12);
  list.same("sun at elevation 1e-9", lit(crown(3), {1, 0.2, 1e-9}), lit(crown(3), {1, 0.2, 1e-6}), 1e-3);
  list.same("sun along z", lit(crown(3), {0, 0, 1}), lit(crown(3), {1e-9, 0, 1}), 2e-3);
  list.same("sun along x, grazing", lit(crown(3), {1, 0, 1e-9}), lit(crown(3), {1, 1e-9, 1e-9}), 2e-3);
  list.safe("sun along x, level", lit(crown(3), {1, 0, 0}));
  list.safe("sun from below", lit(crown(3), {0, 0, -1}));
  list.same("length of to_sun 1e-150", lit(crown(3), 1e-150 * kSun), lit(crown(3)), 1e-6);
  list.safe("grazing sun in a closed canopy",
            lit(generated_layer({.lai = 3, .leaves = 300}), {1, 0.3, 1e-9}));
}

void add_few_leaves(List& list) {
  const Forest level = of_leaves({square_leaf({0, 0, 1}, {0, 0, 1}, 0.1)});
  list.known("one level leaf, sun overhead", lit(level, {0, 0, 1}, kBeam, 0, 0), "direct light", direct,
             kBeam, kBeam, 1e-5);
  list.known("one leaf seen edge-on",
             lit(of_leaves({square_leaf({0, 0, 1}, {1, 0, 0}, 0.1)}), {0, 0, 1}, kBeam, 0, 0), "direct light",
             direct, 0, kBeam, 1e-6);
  list.known("one leaf, even sky",
             lit(of_leaves({square_leaf({0, 0, 1}, {0.3, 0.2, 0.5}, 0.1)}), kSun, 0, kDiffuse, 0),
             "sky on both faces", mean_light, kDiffuse, kDiffuse, 0.03);
  list.safe("one leaf on the ground", lit(of_leaves({square_leaf({0, 0, 0}, {0, 0, 1}, 0.1)})));
  list.safe("two leaves in one place",
            lit(of_leaves(std::vector(2, square_leaf({0, 0, 1}, {1, 2, 3}, 0.1)))));
  list.safe("500 leaves in one place",
            lit(of_leaves(std::vector(500, square_leaf({0, 0, 1}, {1, 2, 3}, 0.1)))));
  list.safe("flat crown", lit(flat_crown()));
  list.safe(
      "tiny and giant leaf",
      lit(of_leaves({square_leaf({0, 0, 1}, {1, 0, 1}, 1e-4), square_leaf({0, 0, 50}, {0, 0, 1}, 80)})));
  list.refused("no leaf", lit(of_leaves({})));
  list.refused("no forest", lit(Forest{}));
}

void add_sizes(List& list) {
  // Instances keep positions in double, but leaves and rays are floats in some methods: cells and edges move
  // by the rounding, and with them some leaves.
  list.same("1e6 m away", lit(moved(crown(3), {1e6, -1e6, 1e3})), lit(crown(3)), 0.02);
  list.same("1e4 m away", lit(moved(crown(3), {1e4, 2e4, 100})), lit(crown(3)), 0.01);
  list.same("leaves of 1e-3 m", lit(crown(3, 6e-3f)), lit(crown(3)), 0.01);
  list.same("leaves of 1e3 m", lit(crown(3, 6e3f)), lit(crown(3)), 0.01);
  // A quarter turn takes cubic directions and cells onto themselves; rings of directions not quite.
  list.same("turned by a quarter", lit(turned(crown(3)), {0.5, 0.3, 0.6}), lit(crown(3), {0.3, -0.5, 0.6}),
            0.02);
}

void add_no_numbers(List& list) {
  const auto refuse = [&](const std::string& name, const auto& break_it) {
    for (const auto& [word, value] : {std::pair{"NaN", kNaN}, std::pair{"infinity", kInfinity}}) {
      LitForest scene = lit(crown(3));
      break_it(scene, value);
      list.refused(std::string(word) + " in " + name, std::move(scene));
    }
  };
  refuse("a leaf's place", [](LitForest& s, double v) {
    s.forest.prototypes[0].foliage[7].centre_m.x = static_cast<float>(v);
  });
  refuse("a leaf's area",
         [](LitForest& s, double v) { s.forest.prototypes[0].foliage[7].area_m2 = static_cast<float>(v); });
  refuse("a leaf's edge", [](LitForest& s, double v) {
    s.forest.prototypes[0].foliage[7].half_u_m.y = static_cast<float>(v);
  });
  refuse("a tree's place", [](LitForest& s, double v) { s.forest.instances[0].position_m.y = v; });
  refuse("a tree's scale",
         [](LitForest& s, double v) { s.forest.instances[0].scale = static_cast<float>(v); });
  refuse("the slope", [](LitForest& s, double v) { s.forest.terrain.slope_rad = v; });
  refuse("the way to the sun", [](LitForest& s, double v) { s.light.to_sun.x = v; });
  refuse("the sun's strength", [](LitForest& s, double v) { s.light.bands[0].beam_normal_w_m2 = v; });
  refuse("the sky's strength", [](LitForest& s, double v) { s.light.bands[0].diffuse_horizontal_w_m2 = v; });
  refuse("the ground's albedo", [](LitForest& s, double v) { s.optics.soil_albedo[0] = v; });
  refuse("a leaf's reflectance", [](LitForest& s, double v) {
    s.optics.overrides = {{"*", "VIS", {{v, 0.1, 0.1, 0.1}, 0.0}}};
  });
  list.refused("no way to the sun", lit(crown(3), {0, 0, 0}));
}

}  // namespace

double mean_light(const LightMap& map) { return map.bands.at(0).mean_irradiance_w_m2; }

double mean_part(const LightMap& map, float FaceLight::*part) {
  double sum = 0.0;
  for (const ElementLight& e : map.bands.at(0).elements)
    sum += static_cast<double>(e.front.*part) + e.back.*part;
  return sum / static_cast<double>(map.bands[0].elements.size());
}

std::vector<StabilityScene> stability_scenes() {
  List list;
  add_depths(list);
  add_albedos(list);
  add_suns(list);
  add_few_leaves(list);
  add_sizes(list);
  add_no_numbers(list);
  return std::move(list.scenes);
}

}  // namespace sunfleck
