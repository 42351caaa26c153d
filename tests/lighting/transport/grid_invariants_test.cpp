// What every result of the grid method keeps, what it says about itself, and what it refuses.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>

#include "lighting/base/summaries.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/transport/grid_light.h"

namespace sunfleck::test {
namespace {

const Vec3 kSun(0.3, -0.5, 0.6);

Illumination both(double beam, double diffuse, const Vec3& to_sun = kSun) {
  return sunlight(to_sun, beam, diffuse);
}

LightMap map_of(const Forest& forest, const Illumination& light, const GridOptions& options = {}) {
  return grid_light_map(forest, band_optics(forest, {"NIR"}, 0.2), light, options, {});
}

void expect_close(const FaceLight& a, const FaceLight& b, double relative, std::size_t i) {
  const double scale = 1e-6 + std::max(a.total(), b.total());
  ASSERT_NEAR(a.direct_w_m2, b.direct_w_m2, relative * scale) << i;
  ASSERT_NEAR(a.sky_w_m2, b.sky_w_m2, relative * scale) << i;
  ASSERT_NEAR(a.scattered_w_m2, b.scattered_w_m2, relative * scale) << i;
}

void expect_close(const LightMap& a, const LightMap& b, double relative) {
  for (std::size_t i = 0; i < a.bands[0].elements.size(); ++i) {
    expect_close(a.bands[0].elements[i].front, b.bands[0].elements[i].front, relative, i);
    expect_close(a.bands[0].elements[i].back, b.bands[0].elements[i].back, relative, i);
  }
}

template <class Change>
LightMap changed(LightMap map, const Change& change) {
  for (std::size_t i = 0; i < map.bands[0].elements.size(); ++i) {
    change(map.bands[0].elements[i].front, i, true);
    change(map.bands[0].elements[i].back, i, false);
  }
  return map;
}

// A crown and an endless layer.
class Invariants : public testing::TestWithParam<bool> {
 protected:
  const Forest forest = GetParam() ? generated_layer({.lai = 3, .leaves = 3000})
                                   : generated_crown({.leaves = 3000, .crown_lai = 3});
};
INSTANTIATE_TEST_SUITE_P(CrownAndLayer, Invariants, testing::Bool());

TEST_P(Invariants, LinearInTheStrengths) {
  const LightMap one = map_of(forest, both(500, 100));
  const LightMap scaled = changed(map_of(forest, both(5e6, 1e6)), [](FaceLight& f, std::size_t, bool) {
    f = {f.direct_w_m2 * 1e-4f, f.sky_w_m2 * 1e-4f, f.scattered_w_m2 * 1e-4f};
  });
  expect_close(one, scaled, 2e-5);  // floats, added over the orders
}

TEST_P(Invariants, AdditiveInTheSourcesWithinConvergence) {
  const LightMap sum = map_of(forest, both(500, 100));
  const LightMap sun = map_of(forest, both(500, 0)), sky = map_of(forest, both(0, 100));
  const LightMap added = changed(sun, [&](FaceLight& f, std::size_t i, bool front) {
    const ElementLight& e = sky.bands[0].elements[i];
    const FaceLight& other = front ? e.front : e.back;
    f = {f.direct_w_m2 + other.direct_w_m2, f.sky_w_m2 + other.sky_w_m2,
         f.scattered_w_m2 + other.scattered_w_m2};
  });
  expect_close(sum, added, 5e-3);  // convergence 2e-3 of the mean; a single leaf may be twice that off
  EXPECT_NEAR(sum.bands[0].mean_irradiance_w_m2,
              sun.bands[0].mean_irradiance_w_m2 + sky.bands[0].mean_irradiance_w_m2,
              2e-3 * sum.bands[0].mean_irradiance_w_m2);
}

TEST_P(Invariants, ConvergesToOneAnswer) {
  const LightMap usual = map_of(forest, both(500, 100));
  const LightMap fine = map_of(forest, both(500, 100), {.convergence = 1e-6, .max_iterations = 1000});
  EXPECT_NEAR(usual.bands[0].mean_irradiance_w_m2 / fine.bands[0].mean_irradiance_w_m2, 1.0, 2e-3);
}

TEST_P(Invariants, SameFarFromTheOrigin) {
  const LightMap here = map_of(forest, both(500, 100));
  for (const double away : {1e4, 1e6}) {
    Forest there = forest;
    there.instances[0].position_m = Vec3(away, 2 * away, away);
    there.terrain.elevation_m = away;
    if (there.period) there.period->origin_m += Vec2(away, 2 * away);
    expect_close(here, map_of(there, both(500, 100)), 2e-4);  // 1e6 m leaves 1e-10 m: cells and floats
  }
}

TEST(Crown, TurnsWithTheSceneByAQuarter) {
  const Forest forest = generated_crown({.leaves = 3000, .crown_lai = 3});
  const LightMap before = map_of(forest, both(500, 100));
  Forest turned = forest;
  turned.instances[0].yaw_rad = static_cast<float>(kPi / 2);
  const LightMap after = map_of(turned, both(500, 100, {-kSun.y, kSun.x, kSun.z}));
  expect_close(before, after, 2e-4);  // the yaw is a float, 4e-8 off a quarter turn
}

TEST_P(Invariants, SameBytesForOneAndTwoThreads) {
  LightMap one, two;
  with_threads(1, [&] { one = map_of(forest, both(500, 100)); });
  with_threads(2, [&] { two = map_of(forest, both(500, 100)); });
  const auto& a = one.bands[0].elements;
  const auto& b = two.bands[0].elements;
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(ElementLight)), 0);
  EXPECT_EQ(one.sunlit_fraction, two.sunlit_fraction);
  EXPECT_EQ(one.bands[0].mean_irradiance_w_m2, two.bands[0].mean_irradiance_w_m2);
  EXPECT_EQ(one.bands[0].budget.residual_w, two.bands[0].budget.residual_w);
}

TEST_P(Invariants, NothingFromNothing) {
  const LightMap dark = map_of(forest, both(0, 0));
  for (const ElementLight& e : dark.bands[0].elements) {
    ASSERT_EQ(e.front.total(), 0.0f);
    ASSERT_EQ(e.back.total(), 0.0f);
  }
}

TEST_P(Invariants, FourReflectancesAreTurnedWithTheLeaf) {
  Forest flipped = forest;
  for (FoliageElement& e : flipped.prototypes[0].foliage) std::swap(e.half_u_m, e.half_v_m);
  const LeafOptics leaf{.reflectance_front = 0.5,
                        .reflectance_back = 0.1,
                        .transmittance_front = 0.2,
                        .transmittance_back = 0.3};
  const LeafOptics other{.reflectance_front = 0.1,
                         .reflectance_back = 0.5,
                         .transmittance_front = 0.3,
                         .transmittance_back = 0.2};
  const auto table = [](const Forest& f, const LeafOptics& optics) {
    return OpticsTable(f,
                       {.bands = {"VIS"}, .soil_albedo = {0.2}, .overrides = {{"*", "VIS", {optics, 0.1}}}});
  };
  const LightMap a = grid_light_map(forest, table(forest, leaf), both(500, 100), {}, {});
  LightMap b = grid_light_map(flipped, table(flipped, other), both(500, 100), {}, {});
  for (ElementLight& e : b.bands[0].elements) std::swap(e.front, e.back);
  expect_close(a, b, 1e-4);
}

// ---- what it says
// ------------------------------------------------------------------------------------------

bool mentions(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

TEST(Provenance, NamesMethodSettingsAndStages) {
  const Forest forest = generated_crown({.leaves = 1500});
  const LightMap map = map_of(forest, both(500, 100));
  EXPECT_EQ(map.provenance.method, "grid");
  EXPECT_EQ(map.provenance.forest_hash, content_hash(forest));
  EXPECT_EQ(map.provenance.settings.at(0), (std::pair<std::string, std::string>("directions", "26")));
  std::vector<std::string> stages;
  for (const StageTime& t : map.provenance.times) stages.push_back(t.stage);
  EXPECT_EQ(stages, (std::vector<std::string>{"leaf-area grid", "sun and sky", "sweeps", "leaf gather"}));
  EXPECT_FALSE(map.bands[0].has_budget);
  EXPECT_TRUE(map_of(generated_layer({.leaves = 1000}), both(1, 1)).bands[0].has_budget);
}

TEST(Provenance, SaysWhereTheMethodIsWeak) {
  const auto notes = [](const Forest& forest, const GridOptions& options = {}) {
    return map_of(forest, both(1, 1), options).provenance.notes;
  };
  EXPECT_TRUE(mentions(notes(generated_crown({.leaves = 299})), "has 299 foliage elements"));
  const Forest enough = generated_crown({.leaves = 1500});
  EXPECT_FALSE(mentions(notes(enough), "foliage elements"));
  EXPECT_FALSE(mentions(notes(enough), "leaf sides"));
  EXPECT_TRUE(mentions(notes(enough, {.cell_m = 0.1}), "smaller than 1.5 leaf sides"));  // side 0.102 m
  EXPECT_TRUE(mentions(notes(generated_crown({.leaves = 4000}), {.memory_limit_bytes = 1 << 20}), "memory"));
  EXPECT_TRUE(mentions(notes(enough, {.convergence = 1e-9, .max_iterations = 2}), "had not converged"));
}

TEST(Skips, SunAndSkyWhereThereAreNone) {
  const Forest forest = generated_crown({.leaves = 1500});
  const LightMap night = map_of(forest, both(500, 100, {1, 0, -0.1}));
  ASSERT_EQ(night.provenance.skipped.size(), 1u);
  EXPECT_EQ(night.provenance.skipped[0].reason, "the sun is not above the horizon");
  EXPECT_EQ(mean_of(night.bands[0], &FaceLight::direct_w_m2), 0.0);
  const LightMap cloudy = map_of(forest, both(0, 100));
  EXPECT_EQ(cloudy.provenance.skipped.at(0).reason, "no band has direct sunlight");
  expect_close(night, cloudy, 0.0);
  const LightMap clear = map_of(forest, both(500, 0));
  EXPECT_EQ(clear.provenance.skipped.at(0).what, "sky sweeps");
  EXPECT_EQ(mean_of(clear.bands[0], &FaceLight::sky_w_m2), 0.0);
}

// ---- what it refuses
// ---------------------------------------------------------------------------------------

struct BadInput {
  const char* name;
  GridOptions options;
  bool leaves;
  Vec3 to_sun;
  const char *where, *what;
};
const BadInput kBadInputs[] = {
    {"directions", {.directions = 9}, true, {0, 0, 1}, "grid.directions", "9"},
    {"negative cell", {.cell_m = -1}, true, {0, 0, 1}, "grid.cell_m", "-1"},
    {"cell is no number", {.cell_m = NAN}, true, {0, 0, 1}, "grid.cell_m", "nan"},
    {"infinite cell", {.cell_m = INFINITY}, true, {0, 0, 1}, "grid.cell_m", "inf"},
    {"no convergence", {.convergence = 0}, true, {0, 0, 1}, "grid.convergence", "0"},
    {"convergence is no number", {.convergence = NAN}, true, {0, 0, 1}, "grid.convergence", "nan"},
    {"no iteration", {.max_iterations = 0}, true, {0, 0, 1}, "grid.max_iterations", "0"},
    {"no leaf", {}, false, {0, 0, 1}, "forest", "no foliage"},
    {"sun from nowhere", {}, true, {0, 0, 0}, "illumination.to_sun", ""},
    {"sun is no direction", {}, true, {NAN, 0, 1}, "illumination.to_sun", ""}};

TEST(BadInput, IsRefusedWithPlaceAndRemedy) {
  for (const BadInput& bad : kBadInputs) {
    const Forest forest =
        forest_of(bad.leaves ? std::vector{leaf_towards({0, 0, 1})} : std::vector<FoliageElement>{});
    Illumination light = skylight(1);
    light.to_sun = bad.to_sun;
    try {
      grid_light(forest, 0.2, light, bad.options);
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput) << bad.name;
      EXPECT_NE(error.where().find(bad.where), std::string::npos) << bad.name << ": " << error.what();
      EXPECT_NE(error.problem().find(bad.what), std::string::npos) << bad.name << ": " << error.what();
      EXPECT_FALSE(error.remedy().empty()) << bad.name;
    }
  }
}

TEST(Stopping, EndsWithCancelledAtEveryStage) {
  const Forest forest = generated_crown({.leaves = 20000});
  const OpticsTable optics = band_optics(forest, {"VIS", "NIR"}, 0.2);
  Illumination light = both(1, 1);
  light.bands.push_back(light.bands[0]);
  for (int stop_at = 1; stop_at <= 3; ++stop_at) {
    std::stop_source source;
    int reports = 0;
    RunControl control;
    control.stop = source.get_token();
    control.progress = [&](std::string_view stage, double) {
      if ((stage == "leaf-area grid" || stage == "sweeps") && ++reports == stop_at) source.request_stop();
    };
    try {
      grid_light_map(forest, optics, light, {}, control);
      ADD_FAILURE() << "ran to its end";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
    }
  }
}

}  // namespace
}  // namespace sunfleck::test
