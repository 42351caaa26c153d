// What every result of envelope_full keeps, for every named correction, and what it refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "lighting/base/summaries.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/envelope/scenes.h"

namespace sunfleck {
namespace {

using test::envelope_full_map;
using test::light_of;
using test::optics_of;

const Vec3 kSun(0.3, -0.5, 0.6);

struct Named {
  const char* name;
  EnvelopeFullOptions options;
};

std::vector<Named> every_correction() {
  std::vector<Named> all = {{"default", {}}};
  const auto with = [&](const char* name, auto change) {
    EnvelopeFullOptions options;
    change(options);
    all.push_back({name, options});
  };
  with("8", [](auto& o) { o.directions = 8; });
  with("50", [](auto& o) { o.directions = 50; });
  with("published_sun", [](auto& o) { o.sun = EnvelopeSun::kPublished; });
  with("spherical", [](auto& o) { o.angles = EnvelopeAngles::kSpherical; });
  with("sun_once", [](auto& o) { o.bounces = EnvelopeBounces::kSunOnce; });
  with("once", [](auto& o) { o.bounces = EnvelopeBounces::kOnce; });
  with("fully_lit", [](auto& o) { o.ground = EnvelopeGround::kFullyLit; });
  with("plain_weights", [](auto& o) { o.weights = EnvelopeWeights::kPlain; });
  with("level_border", [](auto& o) { o.border = EnvelopeBorder::kLevel; });
  with("own_leaf_kept", [](auto& o) { o.own_leaf = EnvelopeOwnLeaf::kKept; });
  return all;
}

class FullInvariants : public testing::TestWithParam<Named> {
 protected:
  LightMap map(const Forest& forest, const Illumination& light) const {
    return envelope_full_map(forest, optics_of(forest, {"VIS"}, 0.2), light, GetParam().options);
  }
  const Forest crown = generated_crown({.leaves = 1200, .crown_lai = 3});
};
INSTANTIATE_TEST_SUITE_P(EveryCorrection, FullInvariants, testing::ValuesIn(every_correction()),
                         [](const auto& one) { return std::string(one.param.name); });

// Every part of every face, relative to the mean light of the map.
void expect_close(const LightMap& a, const LightMap& b, double relative) {
  const double scale = relative * std::max(a.bands[0].mean_irradiance_w_m2, 1e-30);
  for (std::size_t i = 0; i < a.bands[0].elements.size(); ++i) {
    const ElementLight &x = a.bands[0].elements[i], &y = b.bands[0].elements[i];
    for (const auto face : {&ElementLight::front, &ElementLight::back})
      for (const auto part : {&FaceLight::direct_w_m2, &FaceLight::sky_w_m2, &FaceLight::scattered_w_m2})
        ASSERT_NEAR(x.*face.*part, y.*face.*part, scale) << i;
  }
}

LightMap scaled(LightMap map, float factor) {
  for (ElementLight& e : map.bands[0].elements)
    for (FaceLight* f : {&e.front, &e.back})
      *f = {f->direct_w_m2 * factor, f->sky_w_m2 * factor, f->scattered_w_m2 * factor};
  return map;
}

LightMap sum(LightMap a, const LightMap& b) {
  for (std::size_t i = 0; i < a.bands[0].elements.size(); ++i)
    for (const auto face : {&ElementLight::front, &ElementLight::back}) {
      FaceLight& x = a.bands[0].elements[i].*face;
      const FaceLight& y = b.bands[0].elements[i].*face;
      x = {x.direct_w_m2 + y.direct_w_m2, x.sky_w_m2 + y.sky_w_m2, x.scattered_w_m2 + y.scattered_w_m2};
    }
  return a;
}

TEST_P(FullInvariants, LinearAndAdditive) {
  // Floats in the kernel; the ground's rounds stop at 1e-3 of the open ground, which differs per source.
  const LightMap both = map(crown, light_of(kSun, 500, 100));
  expect_close(both, scaled(map(crown, light_of(kSun, 5e6, 1e6)), 1e-4f), 1e-5);
  expect_close(both, sum(map(crown, light_of(kSun, 500, 0)), map(crown, light_of(kSun, 0, 100))), 1e-3);
}

TEST_P(FullInvariants, SameFarFromTheOrigin) {
  const LightMap here = map(crown, light_of(kSun, 500, 100));
  Forest there = crown;
  there.instances[0].position_m = Vec3(1e6, -1e6, 1e4);
  there.terrain.elevation_m = 1e4;
  expect_close(here, map(there, light_of(kSun, 500, 100)), 1e-3);
}

TEST_P(FullInvariants, SameAtAnySize) {
  // Optical depths know no metres: a crown a thousand times as large gets the same light.
  Forest large = crown;
  large.instances[0].scale = 1024.0f;
  expect_close(map(crown, light_of(kSun, 500, 100)), map(large, light_of(kSun, 500, 100)), 1e-3);
}

TEST_P(FullInvariants, TurnsWithTheSceneByAQuarter) {
  const LightMap before = map(crown, light_of(kSun, 500, 100));
  Forest turned = crown;
  turned.instances[0].yaw_rad = static_cast<float>(kPi / 2);
  const LightMap after = map(turned, light_of({-kSun.y, kSun.x, kSun.z}, 500, 100));
  // Rounding moves some leaves on faces of cells into the next cell: those may differ; the mean may not.
  EXPECT_NEAR(before.bands[0].mean_irradiance_w_m2, after.bands[0].mean_irradiance_w_m2,
              1e-3 * before.bands[0].mean_irradiance_w_m2);
}

TEST_P(FullInvariants, SameBytesForAnyNumberOfThreads) {
  LightMap one, two;
  with_threads(1, [&] { one = map(crown, light_of(kSun, 500, 100)); });
  with_threads(2, [&] { two = map(crown, light_of(kSun, 500, 100)); });
  const auto &a = one.bands[0].elements, &b = two.bands[0].elements;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(ElementLight)), 0);
}

TEST_P(FullInvariants, KeepsTheCommonOnesAndSaysWhatItDid) {
  const LightMap light = map(crown, light_of(kSun, 500, 100));
  EXPECT_EQ(find_violation(light, ForestIndex(crown)), "");
  EXPECT_EQ(light.provenance.method, "envelope_full");
  EXPECT_EQ(light.provenance.settings.size(), 10u);
}

TEST(Prepared, ServesAnySunAndSky) {
  const Forest forest = generated_crown({.leaves = 1500, .crown_lai = 3});
  const OpticsTable optics = optics_of(forest, {"PAR", "NIR"}, 0.2);
  const EnvelopePrepared prepared = prepare_envelope(forest, {}, {});
  for (const Vec3& sun : {Vec3(0, 0, 1), Vec3(1, 0, 0.1), Vec3(-0.4, 0.3, 0.5)}) {
    const Illumination light = light_of(sun, 400, 100, 2);
    const LightMap a = envelope_full_light_map(forest, optics, light, prepared, {});
    const LightMap b = envelope_full_map(forest, optics, light, {});
    for (std::size_t band = 0; band < 2; ++band)
      EXPECT_EQ(std::memcmp(a.bands[band].elements.data(), b.bands[band].elements.data(),
                            a.bands[band].elements.size() * sizeof(ElementLight)),
                0);
  }
}

TEST(BouncesFull, OnlyEverAddLight) {
  const Forest forest = generated_crown({.leaves = 1500, .crown_lai = 4});
  const OpticsTable optics = optics_of(forest, {"NIR"}, 0.2);
  double before = 0.0;
  for (const EnvelopeBounces bounces :
       {EnvelopeBounces::kSunOnce, EnvelopeBounces::kOnce, EnvelopeBounces::kAll}) {
    EnvelopeFullOptions options;
    options.bounces = bounces;
    const double scattered =
        test::mean_scattered(envelope_full_map(forest, optics, light_of(kSun, 500, 100), options));
    EXPECT_GT(scattered, before);
    before = scattered;
  }
}

void expect_refused(const Forest& forest, const EnvelopeFullOptions& options, const std::string& where) {
  try {
    prepare_envelope(forest, options, {});
    FAIL() << "accepted " << where;
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), where);
    EXPECT_FALSE(error.remedy().empty());
  }
}

TEST(RefusalsFull, NameTheField) {
  const Forest crown = generated_crown({.leaves = 500});
  for (const int directions : {0, -1, 9, 51}) {
    EnvelopeFullOptions options;
    options.directions = directions;
    expect_refused(crown, options, "envelope_full.directions");
  }
  for (const double cell : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EnvelopeFullOptions options;
    options.cell_m = cell;
    expect_refused(crown, options, "envelope_full.cell_m");
  }
  expect_refused(Forest{}, {}, "forest");
}

TEST(RefusalsFull, AnotherForest) {
  const Forest crown = generated_crown({.leaves = 500}), other = generated_crown({.leaves = 501});
  const EnvelopePrepared prepared = prepare_envelope(crown, {}, {});
  EXPECT_THROW(
      envelope_full_light_map(other, optics_of(other, {"VIS"}, 0), light_of(kSun, 1, 1), prepared, {}),
      Error);
}

TEST(StopFull, EndsWithCancelled) {
  const Forest forest = generated_crown({.leaves = 5000});
  std::stop_source source;
  RunControl control;
  control.stop = source.get_token();
  source.request_stop();
  try {
    prepare_envelope(forest, {}, control);
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
}

}  // namespace
}  // namespace sunfleck
