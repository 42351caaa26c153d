// One door, all methods: invariants that every result keeps, skipping, and what is refused.
#include "lighting/plan/light_request.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "lighting/base/summaries.h"
#include "sim/base/error.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

Forest small_crown() { return generated_crown({.leaves = 600, .crown_lai = 3, .seed = 3}); }

LightRequest request_for(Method method) {
  LightRequest r;
  r.method = method;
  r.optics = {{"PAR", "NIR"}, {0.1, 0.2}, {}};
  r.light.to_sun = direction_from_azimuth_zenith(1.0, 0.6);
  r.light.bands = {{400, 100}, {300, 80}};
  r.reference.rays_per_face = r.reference.sun_rays_per_element = 16;
  return r;
}

LightMap compute(const Forest& forest, const LightRequest& request, int threads = 0) {
  return compute_light_map(forest, request, {.threads = threads}, {});
}

double total(const ElementLight& e) { return static_cast<double>(e.front.total()) + e.back.total(); }

class EveryMethod : public testing::TestWithParam<std::string> {
 protected:
  LightRequest request() const { return request_for(method_from_string(GetParam(), "test")); }
};
INSTANTIATE_TEST_SUITE_P(, EveryMethod, testing::ValuesIn(method_names()),
                         [](const auto& i) { return i.param; });

TEST_P(EveryMethod, KeepsTheInvariantsAndSignsItsResult) {
  const Forest forest = small_crown();
  const LightMap map = compute(forest, request());
  EXPECT_EQ(find_violation(map, ForestIndex(forest)), "");
  EXPECT_EQ(map.provenance.method, GetParam());
  EXPECT_EQ(map.provenance.forest_hash, content_hash(forest));
  EXPECT_FALSE(map.provenance.times.empty());
  EXPECT_GT(map.bands[0].mean_irradiance_w_m2, 0);
  // No leaf gets more in PAR than the whole sky and sun on both faces, with room for what its neighbours
  // scatter.
  for (const ElementLight& e : map.bands[0].elements) EXPECT_LT(total(e), 1.5 * (400 + 2 * 100));
}

TEST_P(EveryMethod, GivesTheSameBytesForOneAndTwoThreads) {
  const Forest forest = small_crown();
  const LightMap one = compute(forest, request(), 1), two = compute(forest, request(), 2);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(std::memcmp(one.bands[b].elements.data(), two.bands[b].elements.data(),
                          one.bands[b].elements.size() * sizeof(ElementLight)),
              0);
    EXPECT_EQ(one.bands[b].standard_error_w_m2, two.bands[b].standard_error_w_m2);
    EXPECT_EQ(one.bands[b].budget.residual_w, two.bands[b].budget.residual_w);
    EXPECT_EQ(one.bands[b].mean_irradiance_standard_error_w_m2,
              two.bands[b].mean_irradiance_standard_error_w_m2);
  }
  EXPECT_EQ(one.sunlit_fraction, two.sunlit_fraction);
}

TEST_P(EveryMethod, IsAdditiveInSunAndSkyAndLinearInStrength) {
  const Forest forest = small_crown();
  LightRequest both = request(), sun = both, sky = both, tripled = both;
  for (std::size_t b = 0; b < 2; ++b) {
    sun.light.bands[b].diffuse_horizontal_w_m2 = 0;
    sky.light.bands[b].beam_normal_w_m2 = 0;
    tripled.light.bands[b].beam_normal_w_m2 *= 3;
    tripled.light.bands[b].diffuse_horizontal_w_m2 *= 3;
  }
  const LightMap a = compute(forest, both), s = compute(forest, sun), d = compute(forest, sky),
                 t = compute(forest, tripled);
  if (GetParam() ==
      "auto") {  // picks and mends by its own measurement: parts add up within its tolerance only
    const double sum = s.bands[0].mean_irradiance_w_m2 + d.bands[0].mean_irradiance_w_m2;
    EXPECT_NEAR(sum, a.bands[0].mean_irradiance_w_m2, 0.1 * sum);
    return;
  }
  for (std::size_t b = 0; b < 2; ++b) {
    const double mean = a.bands[b].mean_irradiance_w_m2;
    for (std::size_t i = 0; i < a.bands[b].elements.size(); ++i) {
      const double sum = total(s.bands[b].elements[i]) + total(d.bands[b].elements[i]);
      // The reference stops iterating at 1e-4 of the scattered power, all else is float rounding.
      ASSERT_NEAR(sum, total(a.bands[b].elements[i]), 2e-3 * mean) << i;
      ASSERT_NEAR(total(t.bands[b].elements[i]), 3 * total(a.bands[b].elements[i]), 3e-3 * mean) << i;
    }
  }
}

TEST_P(EveryMethod, DoesNotCareWhereTheSceneStands) {
  Forest near = small_crown(), far = near;
  for (Instance& i : far.instances) i.position_m += Vec3(1e4, -1e4, 0);
  const LightMap a = compute(near, request()), b = compute(far, request());
  EXPECT_NEAR(b.bands[0].mean_irradiance_w_m2, a.bands[0].mean_irradiance_w_m2,
              1e-3 * a.bands[0].mean_irradiance_w_m2 + 5 * a.bands[0].mean_irradiance_standard_error_w_m2);
}

TEST_P(EveryMethod, SkipsASunThatIsNotUpAndSaysSo) {
  LightRequest night = request();
  night.light.to_sun = {0, 1, -1e-9};
  const LightMap map = compute(small_crown(), night);
  ASSERT_FALSE(map.provenance.skipped.empty());
  EXPECT_EQ(map.provenance.skipped[0].what, "direct sun");
  for (const ElementLight& e : map.bands[0].elements)
    ASSERT_EQ(e.front.direct_w_m2 + e.back.direct_w_m2, 0.0f);
  for (const float f : map.sunlit_fraction) ASSERT_EQ(f, 0.0f);
}

TEST_P(EveryMethod, SurvivesTheHorizonAndTheZenith) {
  for (const Vec3& to_sun : {Vec3(0, 1, 1e-9), Vec3(0, 0, 1), Vec3(1, 0, 1e-3), Vec3(-1, 0, 0)}) {
    LightRequest r = request();
    r.light.to_sun = to_sun;
    const Forest forest = small_crown();
    EXPECT_EQ(find_violation(compute(forest, r), ForestIndex(forest)), "");
  }
}

TEST_P(EveryMethod, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  try {
    compute_light_map(small_crown(), request(), {}, {source.get_token(), {}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
}

TEST_P(EveryMethod, RefusesAForestWithoutLeaves) {
  Forest empty = small_crown();
  empty.instances.clear();
  EXPECT_THROW(compute(empty, request()), Error);
  Forest bare = small_crown();
  bare.prototypes[0].foliage.clear();
  EXPECT_THROW(compute(bare, request()), Error);
}

TEST(Methods, HaveNamesThatReadBack) {
  for (const std::string& name : method_names()) EXPECT_EQ(to_string(method_from_string(name, "x")), name);
  try {
    method_from_string("magic", "light.method");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "light.method");
    EXPECT_NE(error.remedy().find("spp_g"), std::string::npos);
  }
}

TEST(LightRequest, RefusesBadForests) {
  struct Bad {
    const char* says;
    void (*spoil)(Forest&);
  };
  const std::vector<Bad> table = {
      {"finite", [](Forest& f) { f.prototypes[0].foliage[7].centre_m.x = std::nanf(""); }},
      {"negative area", [](Forest& f) { f.prototypes[0].foliage[7].area_m2 = -1; }},
      {"edges", [](Forest& f) { f.prototypes[0].foliage[7].area_m2 *= 2; }},
      {"material", [](Forest& f) { f.prototypes[0].foliage[7].material = 9; }},
      {"scale", [](Forest& f) { f.instances[0].scale = 0; }},
      {"prototype", [](Forest& f) { f.instances[0].prototype = PrototypeId{5}; }},
      {"r + t", [](Forest& f) { f.materials[0].bands[1].leaf_reflectance = 0.99; }},
      {"slope", [](Forest& f) { f.terrain.slope_rad = 1.5; }},
      {"size",
       [](Forest& f) {
         f.period = Period{{0, 0}, {0, 5}};
       }},
  };
  for (const Bad& bad : table) {
    Forest forest = small_crown();
    bad.spoil(forest);
    try {
      compute(forest, request_for(Method::kEnvelope));
      FAIL() << bad.says;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(bad.says), std::string::npos) << error.what();
      EXPECT_FALSE(error.where().empty());
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

}  // namespace
}  // namespace sunfleck
