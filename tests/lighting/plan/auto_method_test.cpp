// `auto` and [light.probes] through the one door: what is chosen, what is said of it, what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stop_token>
#include <thread>

#include "lighting/base/summaries.h"
#include "lighting/plan/auto_probe.h"
#include "lighting/plan/auto_rungs.h"
#include "lighting/plan/auto_time.h"
#include "lighting/plan/light_config.h"
#include "sim/base/error.h"
#include "tests/lighting/plan/auto_scenes.h"

namespace sunfleck::test {
namespace {

Forest crown() { return generated_crown({.leaves = 1500, .crown_lai = 4, .seed = 11}); }

std::string setting(const LightMap& map, const std::string& key) {
  for (const auto& [name, value] : map.provenance.settings)
    if (name == key) return value;
  return {};
}

LightRequest automatic(double tolerance, AutoMeasure measure = AutoMeasure::kElementRms) {
  LightRequest r = sun_and_sky(Method::kAuto);
  r.automatic.tolerance = tolerance;
  r.automatic.measure = measure;
  return r;
}

LightMap compute(const Forest& forest, const LightRequest& request, const RunControl& control = {}) {
  return compute_light_map(forest, request, {}, control);
}

// RMS against a reference of 256 rays, its noise taken out.
double true_rms(const Forest& forest, const LightMap& map, std::size_t band) {
  LightRequest asked = sun_and_sky(Method::kReference);
  asked.reference.seed = 99;
  asked.reference.rays_per_face = asked.reference.sun_rays_per_element = 256;
  const LightMap truth = compute(forest, asked);
  double squares = 0, mean = 0;
  for (std::size_t i = 0; i < map.bands[band].elements.size(); ++i) {
    const double t = parts_of(truth.bands[band].elements[i]).total();
    squares += std::pow(parts_of(map.bands[band].elements[i]).total() - t, 2) -
               std::pow(truth.bands[band].standard_error_w_m2[i], 2);
    mean += t;
  }
  const auto n = static_cast<double>(map.bands[band].elements.size());
  return std::sqrt(squares / n) / (mean / n);
}

TEST(Auto, TakesACheapMethodForAWideToleranceAndSaysWhatItIsWorth) {
  const Forest forest = crown();
  const LightMap map = compute(forest, automatic(0.8));
  EXPECT_EQ(map.provenance.method, "auto");
  EXPECT_EQ(setting(map, "chosen_method").find("reference"), std::string::npos);
  for (const std::size_t b : {0u, 1u}) {
    const std::string& band = map.bands[b].band;
    const double measured = std::stod(setting(map, "measured_element_rms." + band));
    EXPECT_LE(measured, 0.8);
    // 200 probes know an RMS to about a seventh (one standard error: 7 %).
    EXPECT_NEAR(true_rms(forest, map, b), measured, 0.2 * measured) << band;
    EXPECT_NE(setting(map, "measured_bias." + band).find('['), std::string::npos);
    EXPECT_GT(map.bands[b].mean_irradiance_standard_error_w_m2, 0.0);
    EXPECT_TRUE(map.bands[b].standard_error_w_m2.empty());
  }
}

TEST(Auto, TracesForATightTolerance) {
  const Forest forest = crown();
  const LightMap map = compute(forest, automatic(0.035));
  EXPECT_NE(setting(map, "chosen_method").find("links"), std::string::npos) << setting(map, "tried_methods");
  for (const std::size_t b : {0u, 1u})
    EXPECT_LT(true_rms(forest, map, b), 0.042);  // probes know it to a seventh
}

TEST(Auto, EndsWithTheReferenceWhereNothingElseWillDo) {
  const Forest forest = crown();
  LightRequest r = automatic(0.03);
  r.links.memory_limit_bytes = 100000;
  const LightMap map = compute(forest, r);
  EXPECT_EQ(setting(map, "chosen_method"), "reference");
  EXPECT_FALSE(map.bands[0].standard_error_w_m2.empty());
  for (const std::size_t b : {0u, 1u}) EXPECT_LT(true_rms(forest, map, b), 0.035);
}

// Between the two: diffuse light from a cheap method, direct light as the sun sees it. Almost all light is
// direct here.
TEST(Auto, DrawsTheSunWhereThatIsEnough) {
  const Forest forest = crown();
  LightRequest r = automatic(0.12);
  r.light.bands = {{600, 10}, {600, 10}};
  r.optics.overrides = {{"*", "NIR", {{0.1, 0.1, 0.05, 0.05}, 0.1}}};
  const LightMap map = compute(forest, r);
  EXPECT_NE(setting(map, "chosen_method").find("drawn sun"), std::string::npos)
      << setting(map, "tried_methods");
  EXPECT_LE(std::stod(setting(map, "measured_element_rms.PAR")), 0.12);
}

TEST(Auto, HoldsTheMeanForAToleranceOnBias) {
  const Forest forest = crown();
  const LightMap map = compute(forest, automatic(0.1, AutoMeasure::kBias));
  LightRequest asked = sun_and_sky(Method::kReference);
  asked.reference.rays_per_face = asked.reference.sun_rays_per_element = 256;
  const LightMap truth = compute(forest, asked);
  for (const std::size_t b : {0u, 1u}) {
    const double mean = truth.bands[b].mean_irradiance_w_m2;
    EXPECT_NEAR(map.bands[b].mean_irradiance_w_m2, mean, 0.1 * mean);
    // The standard error it states, at three of them.
    EXPECT_NEAR(map.bands[b].mean_irradiance_w_m2, mean,
                3 * map.bands[b].mean_irradiance_standard_error_w_m2);
  }
}

// Every tree's mean (or absorbed flux) against a reference of 256 rays.
TEST(Auto, HoldsAToleranceOnTrees) {
  const Forest forest = small_stand();
  LightRequest asked = sun_and_sky(Method::kReference);
  asked.reference.rays_per_face = asked.reference.sun_rays_per_element = 256;
  const LightMap truth = compute(forest, asked);
  for (const AutoMeasure measure : {AutoMeasure::kTreeRms, AutoMeasure::kTreeAbsorbedRms}) {
    const LightMap map = compute(forest, automatic(0.15, measure));
    EXPECT_NE(setting(map, "measured_" + to_string(measure) + ".PAR"), "");
    for (const std::size_t b : {0u, 1u}) {
      double squares = 0, mean = 0;
      for (std::size_t t = 0; t < map.bands[b].trees.size(); ++t) {
        const TreeLight &x = map.bands[b].trees[t], &y = truth.bands[b].trees[t];
        const bool absorbed = measure == AutoMeasure::kTreeAbsorbedRms;
        squares += std::pow(
            absorbed ? x.absorbed_w - y.absorbed_w : x.mean_irradiance_w_m2 - y.mean_irradiance_w_m2, 2);
        mean += absorbed ? y.absorbed_w : y.mean_irradiance_w_m2;
      }
      const auto n = static_cast<double>(map.bands[b].trees.size());
      // 25 draws of trees know the RMS to about a quarter.
      EXPECT_LT(std::sqrt(squares / n) / (mean / n), 1.25 * 0.15) << to_string(measure) << " " << b;
    }
  }
}

TEST(Auto, MeasuresLayers) {
  LightRequest r = automatic(0.3, AutoMeasure::kLayerRms);
  r.automatic.layers = 4;
  const LightMap map = compute(crown(), r);
  EXPECT_LE(std::stod(setting(map, "measured_layer_rms.PAR")), 0.3);
}

TEST(Auto, GivesTheBestWithinATimeAndSaysWhatItIsWorth) {
  LightRequest r = sun_and_sky(Method::kAuto);
  r.automatic.time_s = 0.4;
  const LightMap map = compute(crown(), r);
  EXPECT_EQ(setting(map, "time_s"), "0.4");
  EXPECT_EQ(setting(map, "tolerance"), "");
  EXPECT_NE(setting(map, "chosen_method"), "");
  EXPECT_NE(setting(map, "measured_element_rms.NIR").find('['), std::string::npos);
  for (const std::string& note : map.provenance.notes)
    EXPECT_EQ(note.find("not reached"), std::string::npos) << note;
}

// Mostly diffuse light: tracing links is enough where cells are not.
TEST(Auto, AnswersDiffuseLightWithoutTheReference) {
  LightRequest r = automatic(0.1);
  r.light.bands = {{0, 100}, {0, 80}};
  const LightMap map = compute(crown(), r);
  EXPECT_EQ(setting(map, "chosen_method").find("reference"), std::string::npos)
      << setting(map, "tried_methods");
  EXPECT_LE(std::stod(setting(map, "measured_element_rms.PAR")), 0.1) << setting(map, "tried_methods");
}

TEST(Auto, LeavesTheLightOfASingleLeafWhereItBelongs) {
  Forest forest = crown();
  FoliageElement leaf = forest.prototypes[0].foliage[0];
  leaf.half_u_m = {0.05f, 0, 0};
  leaf.half_v_m = {0, 0.05f, 0};
  leaf.area_m2 = 0.01f;
  forest.prototypes[0].foliage = {leaf};
  LightRequest r = automatic(0.1);
  r.light.to_sun = {0, 0, 1};
  r.light.bands = {{400, 0}, {300, 0}};
  r.optics.soil_albedo = {0, 0};
  const LightMap map = compute(forest, r);
  // Level, so all of the beam on its upper face but for the cosines of the disc, 1e-5.
  EXPECT_NEAR(map.bands[0].elements[0].front.direct_w_m2, 400, 0.01);
  EXPECT_NEAR(map.bands[1].elements[0].front.direct_w_m2, 300, 0.01);
  EXPECT_NEAR(map.bands[0].elements[0].front.scattered_w_m2, 0, 0.01);
}

TEST(Deadline, StopsWorkWhenItsTimeIsOverAndNotBefore) {
  const RunControl nobody_stops;
  {
    const Deadline far(nobody_stops, 1e6);
    EXPECT_NO_THROW(far.control().check());
    EXPECT_FALSE(far.passed());
  }
  const Deadline over(nobody_stops, 0.0);
  while (!over.passed()) std::this_thread::yield();
  EXPECT_THROW(while (true) over.control().check(), Error);
}

TEST(Deadline, HandsOnTheStopOfItsCaller) {
  std::stop_source source;
  const RunControl outer{source.get_token(), {}};
  const Deadline far(outer, 1e6);
  source.request_stop();
  EXPECT_THROW(far.control().check(), Error);
  EXPECT_FALSE(far.passed());
}

TEST(Rungs, TheLeastExpectedCostIsTriedFirst) {
  std::vector<Rung> rungs(3);
  rungs[0].predicted_error = 0.2, rungs[0].predicted_s = 0.1;    // will not do
  rungs[1].predicted_error = 0.099, rungs[1].predicted_s = 1.0;  // as likely as not
  rungs[2].predicted_error = 0.05, rungs[2].predicted_s = 1.5;
  EXPECT_EQ(best_rung(rungs, 0.1, 1.0), 2);
  rungs[2].predicted_s = 4.0;
  EXPECT_EQ(best_rung(rungs, 0.1, 1.0), 1);
  EXPECT_EQ(best_rung(rungs, 0.1, 3.0), -1);  // grids turned out three times worse
  EXPECT_EQ(best_rung({}, 0.1, 1.0), -1);
}

TEST(Auto, SaysWhenTheToleranceIsOutOfReach) {
  LightRequest r = automatic(0.001);
  r.reference.max_rays_per_face = 32;
  const LightMap map = compute(crown(), r);
  ASSERT_FALSE(map.provenance.notes.empty());
  EXPECT_NE(map.provenance.notes.back().find("not reached"), std::string::npos);
}

TEST(Auto, GivesTheBestThereIsWhereTheReferenceDoesNotFit) {
  LightRequest r = automatic(0.01);
  r.reference.memory_limit_bytes = 100000;
  const LightMap map = compute(crown(), r);
  EXPECT_EQ(setting(map, "chosen_method").find("reference"), std::string::npos);
  bool said = false;
  for (const std::string& note : map.provenance.notes) said |= note.find("was not run") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(Probes, MeasureTheErrorOfAnyMethodAndChangeNoLight) {
  const Forest forest = crown();
  for (const Method method : {Method::kSpp, Method::kEnvelope, Method::kReference}) {
    LightRequest r = sun_and_sky(method);
    const LightMap plain = compute(forest, r);
    r.probes = ProbePlan{.count = 100};
    const LightMap measured = compute(forest, r);
    EXPECT_EQ(setting(plain, "measured_bias.PAR"), "");
    EXPECT_NE(setting(measured, "measured_bias.PAR"), "");
    EXPECT_EQ(setting(measured, "probes"), "100");
    EXPECT_EQ(std::memcmp(plain.bands[1].elements.data(), measured.bands[1].elements.data(),
                          plain.bands[1].elements.size() * sizeof(ElementLight)),
              0);
    if (method == Method::kReference) {
      EXPECT_EQ(plain.bands[0].mean_irradiance_standard_error_w_m2,
                measured.bands[0].mean_irradiance_standard_error_w_m2);
    }
  }
}

TEST(Probes, ReportTheirStageAndStop) {
  LightRequest r = sun_and_sky(Method::kEnvelope);
  r.probes = ProbePlan{};
  std::stop_source source;
  const RunControl control{source.get_token(), [&](std::string_view stage, double) {
                             if (stage == "probing") source.request_stop();
                           }};
  try {
    compute(crown(), r, control);
    FAIL() << "never probing, or not stopped";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kCancelled);
  }
}

TEST(Auto, RefusesBadOptionsByName) {
  struct Bad {
    const char* where;
    void (*spoil)(LightRequest&);
  };
  const std::vector<Bad> table = {
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = 0; }},
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = -0.1; }},
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = NAN; }},
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = 1.01; }},
      {"probes.count", [](LightRequest& r) { r.probes = ProbePlan{.count = 15}; }},
      {"probes.paths_per_face", [](LightRequest& r) { r.probes = ProbePlan{.paths_per_face = 1}; }},
      {"probes.sun_rays", [](LightRequest& r) { r.probes = ProbePlan{.sun_rays = 70000}; }},
  };
  for (const Bad& bad : table) {
    LightRequest r = automatic(0.5);
    bad.spoil(r);
    try {
      compute(crown(), r);
      FAIL() << bad.where;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::kInvalidInput);
      EXPECT_EQ(e.where(), bad.where);
      EXPECT_FALSE(e.remedy().empty());
    }
  }
}

LightRequest read(const std::string& text) {
  const ConfigTable root = ConfigTable::from_text(text, "scene.toml");
  LightRequest request = read_light_request(root.table("light"));
  root.reject_unread();
  return request;
}

const std::string kScene = R"([light]
method = "auto"
[[light.bands]]
name = "PAR"
diffuse_horizontal_w_m2 = 50
[light.auto]
tolerance = 0.2
measure = "bias"
[light.probes]
count = 300
paths_per_face = 16
sun_rays = 32
seed = 7
)";

TEST(AutoConfig, IsRead) {
  const LightRequest r = read(kScene);
  EXPECT_EQ(r.method, Method::kAuto);
  EXPECT_EQ(r.automatic.tolerance, 0.2);
  EXPECT_EQ(r.automatic.measure, AutoMeasure::kBias);
  ASSERT_TRUE(r.probes);
  EXPECT_EQ(r.probes->count, 300);
  EXPECT_EQ(r.probes->paths_per_face, 16);
  EXPECT_EQ(r.probes->sun_rays, 32);
  EXPECT_EQ(r.probes->seed, 7u);
  EXPECT_FALSE(read(kScene.substr(0, kScene.find("[light.auto]"))).probes);
}

TEST(GridConfig, IsReadAndRefusesMistakes) {
  const std::string text = R"([light]
method = "grid"
[[light.bands]]
name = "PAR"
[light.grid]
directions = 14
cell_m = 0.5
convergence = 0.01
max_iterations = 9
)";
  const LightRequest r = read(text);
  EXPECT_EQ(r.method, Method::kGrid);
  EXPECT_EQ(r.grid.directions, 14);
  EXPECT_EQ(r.grid.cell_m, 0.5);
  EXPECT_EQ(r.grid.convergence, 0.01);
  EXPECT_EQ(r.grid.max_iterations, 9);
  const std::vector<std::pair<std::string, std::string>> bad = {{"= 14", "= 12"},
                                                                {"cell_m = 0.5", "cell_m = -1"},
                                                                {"convergence = 0.01", "convergence = 0"},
                                                                {"= 9", "= 0"},
                                                                {"directions = 14", "direction = 14"}};
  for (const auto& [from, to] : bad) {
    std::string spoiled = text;
    spoiled.replace(spoiled.find(from), from.size(), to);
    EXPECT_THROW(read(spoiled), Error) << to;
  }
}

TEST(AutoConfig, RefusesMistakesByLineAndKey) {
  struct Bad {
    std::string from, to, where;
  };
  const std::vector<Bad> table = {
      {"tolerance = 0.2", "tolerance = 0", "scene.toml:7: light.auto.tolerance"},
      {"tolerance = 0.2", "tolerance = nan", "scene.toml:7: light.auto.tolerance"},
      {"tolerance = 0.2", "tolerance = 2", "scene.toml:7: light.auto.tolerance"},
      {"\"bias\"", "\"median\"", "scene.toml:8: light.auto.measure"},
      {"count = 300", "count = 15", "scene.toml:10: light.probes.count"},
      {"count = 300", "count = 20.5", "scene.toml:10: light.probes.count"},
      {"paths_per_face = 16", "paths_per_face = 1", "scene.toml:11: light.probes.paths_per_face"},
      {"sun_rays = 32", "sun_rayz = 32", "scene.toml:12: light.probes.sun_rayz"},
  };
  for (const Bad& bad : table) {
    std::string text = kScene;
    text.replace(text.find(bad.from), bad.from.size(), bad.to);
    try {
      read(text);
      FAIL() << bad.to;
    } catch (const Error& e) {
      EXPECT_EQ(e.where(), bad.where) << e.what();
    }
  }
}

}  // namespace
}  // namespace sunfleck::test
