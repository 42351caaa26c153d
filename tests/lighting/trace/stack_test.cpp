// Stacks of closed horizontal sheets over soil (cases "stack_*"): every ray from a sheet meets its neighbour,
// so the answer of the adding method must come back to the accuracy of the iteration, whatever the sky.
#include <gtest/gtest.h>

#include "tests/lighting/trace/golden_cases.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

Forest stack(int sheets, double rho, double tau) {
  std::vector<FoliageElement> leaves;
  for (int k = 0; k < sheets; ++k)  // top down
    for (const Vec2 quarter : {Vec2(-0.25, -0.25), {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}})
      leaves.push_back(quad({quarter, 0.5 * (sheets - k)}, {0.25, 0, 0}, {0, 0.25, 0}));
  Forest forest = forest_of(leaves, {Leaf{rho, tau}});
  forest.period = Period{{-0.5, -0.5}, {1, 1}};
  return forest;
}

void expect_stack(const nlohmann::json& c, const Illumination& light) {
  SCOPED_TRACE(c["id"].get<std::string>());
  const int sheets = c["inputs"]["n"];
  const Forest forest = stack(sheets, c["inputs"]["rho"], c["inputs"]["tau"]);
  const double soil = c["inputs"]["soil"];
  ReferenceOptions o;
  o.rays_per_face = 32;
  o.convergence = 1e-7;
  const LightMap map = trace_light(forest, soil, light, o);
  const auto& expected = c["expected"];
  for (int k = 0; k < sheets; ++k) {
    double absorbed = 0.0;
    for (std::size_t q = 0; q < 4; ++q) {
      const ElementLight& e = map.bands[0].elements[4 * static_cast<std::size_t>(k) + q];
      absorbed += e.absorbed_w;
      EXPECT_NEAR(e.front.total(), expected["irradiance_on_upper_face"][k].get<double>(), 0.002);
      EXPECT_NEAR(e.back.total(), expected["irradiance_on_lower_face"][k].get<double>(), 0.002);
    }
    EXPECT_NEAR(absorbed, expected["absorbed_per_layer_top_down"][k].get<double>(), 0.002);
  }
  const EnergyBudget& b = map.bands[0].budget;
  EXPECT_NEAR(b.absorbed_ground_w, expected["soil_absorbed"].get<double>(), 0.002);
  EXPECT_NEAR(b.escaped_w, expected["albedo"].get<double>(), 0.002);
  EXPECT_NEAR(b.incident_w, 1.0, 1e-9);
  expect_sound(map, forest);
}

TEST(Stack, EveryCaseUnderEverySky) {
  int cases = 0;
  const nlohmann::json all = golden("light_cases.json");
  for (const auto& c : all["cases"]) {
    if (!c["id"].get<std::string>().starts_with("stack_")) continue;
    ++cases;
    expect_stack(c, skylight(1.0));
    expect_stack(c, sunlight({0, 0, 1}, 1.0));
    expect_stack(c, sunlight({1, 0.5, 1}, 1.5));  // a slanting sun with 1 on the horizontal
  }
  EXPECT_EQ(cases, 13);
}

// A sheet of unlike faces over black soil: light on its front gives r_f back and t_f through, on its back r_b
// and t_b; turned over, the faces change places.
TEST(Stack, UnlikeFaces) {
  MaterialOptics unlike;
  unlike.leaf = {0.30, 0.15, 0.25, 0.05};  // r_f, r_b, t_f, t_b
  for (const bool face_up : {true, false}) {
    const double turn = face_up ? 1.0 : -1.0;
    Forest forest = forest_of({quad({0, 0, 1}, {0.5, 0, 0}, {0, 0.5 * turn, 0})});
    forest.period = Period{{-0.5, -0.5}, {1, 1}};
    const OpticsTable optics(forest,
                             {.bands = {"B"}, .soil_albedo = {0.0}, .overrides = {{"*", "B", unlike}}});
    const LightMap map = reference_light_map(forest, optics, skylight(1.0), {}, {});
    const EnergyBudget& b = map.bands[0].budget;
    EXPECT_NEAR(b.escaped_w, face_up ? 0.30 : 0.15, 1e-5);
    EXPECT_NEAR(b.absorbed_ground_w, face_up ? 0.25 : 0.05, 1e-5);
    EXPECT_NEAR(b.absorbed_foliage_w, face_up ? 0.45 : 0.80, 1e-5);
    EXPECT_NEAR(face_up ? map.bands[0].elements[0].front.total() : map.bands[0].elements[0].back.total(), 1.0,
                1e-5);
  }
}

}  // namespace
}  // namespace sunfleck::test
