// Skips: what is left out changes no element by more than the bound that is stated, and what the plan says
// before any work. The reference is run with the same rays with and without the skip, so that the difference
// is the skip's alone.
#include "lighting/plan/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lighting/plan/light_config.h"
#include "lighting/plan/light_session.h"
#include "sim/base/error.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

Forest crown() {
  return generated_crown({.kind = CrownKind::kClumped, .leaves = 500, .crown_lai = 3, .seed = 4});
}
// Leaves of 2 cm, 0.3 m apart: no leaf sees much of the others.
Forest sparse() {
  Forest forest = generated_crown({.leaves = 48, .radius_m = 1, .crown_lai = 0.006, .seed = 2});
  int i = 0;
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    e.centre_m = 0.3f * Vec3f(static_cast<float>(i % 4), static_cast<float>(i / 4 % 4),
                              static_cast<float>(2 + i / 16));
    ++i;
  }
  return forest;
}

LightRequest request_for(Method method, double albedo, double soil) {
  LightRequest r;
  r.method = method;
  r.optics = {{"PAR", "NIR"}, {soil, soil}, {}};
  for (const char* band : {"PAR", "NIR"})
    r.optics.overrides.push_back({"*", band, {{albedo / 2, albedo / 2, albedo / 2, albedo / 2}, albedo}});
  r.light.to_sun = direction_from_azimuth_zenith(1.0, 0.6);
  r.light.sun_half_angle_rad = radians_from_degrees(0.265);
  r.light.bands = {{400, 100}, {30, 300}};
  r.reference.rays_per_face = r.reference.sun_rays_per_element = 64;
  r.reference.convergence = 1e-7;
  return r;
}

double total(const ElementLight& e) { return static_cast<double>(e.front.total()) + e.back.total(); }

struct SkipCase {
  const char* what;
  Forest (*forest)();
  double albedo, soil;
};

class Skips : public testing::TestWithParam<std::tuple<SkipCase, Method>> {};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Float rounding of sums of a few hundred W m-2.
constexpr double kRounding_w_m2 = 1e-3;

TEST_P(Skips, ChangeNoElementByMoreThanTheirBound) {
  const auto& [c, method] = GetParam();
  const Forest forest = c.forest();
  const LightSession session(forest);
  LightRequest request = request_for(method, c.albedo, c.soil);
  const Plan plan = session.plan(request);
  const auto skip =
      std::find_if(plan.skips.begin(), plan.skips.end(),
                   [&, what = c.what](const PlannedSkip& s) { return s.what.starts_with(what); });
  ASSERT_NE(skip, plan.skips.end());
  const LightMap with = session.compute(request, {}, {});
  request.skip = Skipping::kNever;
  const LightMap without = session.compute(request, {}, {});
  for (std::size_t b = 0; b < 2; ++b) {
    double largest = 0.0;
    for (std::size_t e = 0; e < with.bands[b].elements.size(); ++e)
      largest =
          std::max(largest, std::abs(total(with.bands[b].elements[e]) - total(without.bands[b].elements[e])));
    EXPECT_LE(largest, skip->bound_w_m2[b] + kRounding_w_m2) << with.bands[b].band;
    EXPECT_GT(largest, 0.0) << "nothing was skipped in " << with.bands[b].band;
    // What is absorbed follows from the true optics.
    EXPECT_NEAR(with.bands[b].trees[0].absorbed_w / without.bands[b].trees[0].absorbed_w, 1.0,
                skip->bound_w_m2[b] / without.bands[b].mean_irradiance_w_m2 + 1e-6);
  }
  const auto note = std::find_if(with.provenance.skipped.begin(), with.provenance.skipped.end(),
                                 [&, what = c.what](const SkipNote& s) { return s.what.starts_with(what); });
  ASSERT_NE(note, with.provenance.skipped.end());
  EXPECT_GT(note->relative_bound, 0.0);
  for (const SkipNote& n : without.provenance.skipped) EXPECT_EQ(n.relative_bound, 0.0) << n.what;
}

INSTANTIATE_TEST_SUITE_P(, Skips,
                         testing::Combine(testing::Values(SkipCase{"bounces in", crown, 0.019, 0.01},
                                                          SkipCase{"bounces after the first", crown, 0.09,
                                                                   0.05},
                                                          SkipCase{"light off leaves", sparse, 0.3, 0.2}),
                                          testing::Values(Method::kReference, Method::kGrid)));

TEST(Plan, SkipsNothingThatMatters) {
  const Forest forest = crown();
  const LightSession session(forest);
  EXPECT_TRUE(session.plan(request_for(Method::kReference, 0.15, 0.1)).skips.empty());
  EXPECT_TRUE(session.plan(request_for(Method::kReference, 0.01, 0.1)).skips.empty());  // bright soil
  LightRequest never = request_for(Method::kReference, 0.01, 0.0);
  never.skip = Skipping::kNever;
  EXPECT_TRUE(session.plan(never).skips.empty());
  never.light.to_sun = {0, 1, -0.1};
  EXPECT_EQ(session.plan(never).skips.at(0).what, "direct sun");  // there is none: no matter of skipping
}

TEST(Plan, TellsTheViewOfOthers) {
  // Two leaves of area A at distance d, small against it: A / (pi d^2), with d less their half diagonals.
  Forest two = sparse();
  two.prototypes[0].foliage.resize(2);
  for (FoliageElement& e : two.prototypes[0].foliage) e.centre_m = {0, 0, 1};
  two.prototypes[0].foliage[1].centre_m = {3, 0, 1};
  const FoliageElement& e = two.prototypes[0].foliage[1];
  const double reach = glm::length(e.half_u_m) + glm::length(e.half_v_m);
  EXPECT_NEAR(*largest_view_of_others(two, ForestIndex(two)), e.area_m2 / (kPi * std::pow(3 - 2 * reach, 2)),
              1e-6);
  two.prototypes[0].foliage[1].centre_m = {0, 0, 1.001f};
  EXPECT_EQ(*largest_view_of_others(two, ForestIndex(two)), 1.0);
  EXPECT_FALSE(largest_view_of_others(crown(), ForestIndex(crown()), 100));
}

TEST(Plan, PredictsMoreForMore) {
  const Forest few = crown(), many = generated_crown({.leaves = 5000, .crown_lai = 3});
  const LightSession small(few), large(many);
  for (const std::string& name : method_names()) {
    LightRequest r = request_for(method_from_string(name, "test"), 0.15, 0.1);
    const Plan a = small.plan(r), b = large.plan(r);
    EXPECT_GT(a.predicted_s, 0.0) << name;
    EXPECT_GT(b.predicted_s, a.predicted_s) << name;
    EXPECT_GT(b.predicted_bytes, a.predicted_bytes) << name;
  }
  LightRequest rays = request_for(Method::kReference, 0.15, 0.1);
  const double before = small.plan(rays).predicted_bytes;
  rays.reference.rays_per_face *= 4;
  EXPECT_GT(small.plan(rays).predicted_bytes, before);
  LightRequest loose = request_for(Method::kAuto, 0.15, 0.1), tight = loose;
  loose.automatic.tolerance = 0.3;
  tight.automatic.tolerance = 0.03;
  EXPECT_GT(small.plan(tight).predicted_bytes, small.plan(loose).predicted_bytes);
}

TEST(Plan, RefusesBadInputBeforeAnyWork) {
  struct Bad {
    const char* where;
    void (*spoil)(LightRequest&);
  };
  const std::vector<Bad> table = {
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = 0; }},
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = -1; }},
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = kNaN; }},
      {"auto.tolerance", [](LightRequest& r) { r.automatic.tolerance = 1.001; }},
      {"auto.time_s", [](LightRequest& r) { r.automatic.time_s = 0; }},
      {"auto.time_s", [](LightRequest& r) { r.automatic.time_s = -2; }},
      {"auto.time_s", [](LightRequest& r) { r.automatic.time_s = kNaN; }},
      {"auto.time_s", [](LightRequest& r) { r.automatic.time_s = INFINITY; }},
      {"auto.time_s", [](LightRequest& r) { r.automatic.time_s = 1e-6; }},  // less than the cheapest needs
      {"auto.time_s", [](LightRequest& r) { r.automatic.tolerance = 0.1, r.automatic.time_s = 1; }},
      {"auto.layer_m", [](LightRequest& r) { r.automatic.layer_m = 0; }},
      {"auto.layer_m", [](LightRequest& r) { r.automatic.layer_m = kNaN; }},
      {"auto.layers", [](LightRequest& r) { r.automatic.layers = -1; }},
      {"auto.layers", [](LightRequest& r) { r.automatic.layers = 10001; }},
      {"grid.cell_m", [](LightRequest& r) { r.grid.cell_m = 1e-5; }},
      {"probes.count", [](LightRequest& r) { r.probes = ProbePlan{.count = 15}; }},
  };
  const Forest forest = crown();
  const LightSession session(forest);
  for (const Bad& bad : table) {
    LightRequest r = request_for(Method::kAuto, 0.15, 0.1);
    bad.spoil(r);
    bool worked = false;
    const RunControl control{{}, [&](std::string_view, double) { worked = true; }};
    try {
      session.compute(r, {}, control);
      FAIL() << bad.where;
    } catch (const Error& e) {
      EXPECT_EQ(e.where(), bad.where) << e.what();
      EXPECT_FALSE(e.remedy().empty());
    }
    EXPECT_FALSE(worked) << bad.where;
  }
}

TEST(Plan, SaysWhatAnImpossibleTimeNeeds) {
  const Forest forest = crown();
  LightRequest r = request_for(Method::kAuto, 0.15, 0.1);
  r.automatic.time_s = 1e-6;
  try {
    LightSession(forest).compute(r, {}, {});
    FAIL();
  } catch (const Error& e) {
    EXPECT_GT(std::stod(e.remedy().substr(6)), 1e-6) << e.remedy();  // "about X s or more, ..."
  }
}

TEST(PlanConfig, RefusesToleranceAndTimeTogetherAndUnknownKnobs) {
  const auto read = [](const std::string& knobs) {
    const ConfigTable root = ConfigTable::from_text(
        "[light]\nmethod = \"auto\"\n[[light.bands]]\nname = \"PAR\"\n[light.auto]\n" + knobs, "scene.toml");
    const LightRequest r = read_light_request(root.table("light"));
    root.reject_unread();
    return r;
  };
  const LightRequest timed = read("time_s = 0.2\nmeasure = \"layer_rms\"\nlayers = 4\n");
  EXPECT_EQ(timed.automatic.time_s, 0.2);
  EXPECT_FALSE(timed.automatic.tolerance);
  EXPECT_EQ(timed.automatic.measure, AutoMeasure::kLayerRms);
  EXPECT_EQ(timed.automatic.layers, 4);
  for (const char* bad : {"time_s = 0.2\ntolerance = 0.1\n", "time_s = 0\n", "time_s = -1\n",
                          "time_s = nan\n", "tolerance = 0\n", "tolerance = nan\n", "tolerance = 2\n",
                          "measure = \"magic\"\n", "layer_m = 0\n", "tolerence = 0.1\n"})
    EXPECT_THROW(read(bad), Error) << bad;
}

}  // namespace
}  // namespace sunfleck
