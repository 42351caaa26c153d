// What every result of the envelope estimator keeps, what it says about itself, and what it refuses.
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

using test::envelope_map;
using test::forest_of;
using test::light_of;
using test::optics_of;
using test::square_leaf;

const Vec3 kSun(0.3, -0.5, 0.6);

void expect_close(const FaceLight& a, const FaceLight& b, double relative, std::size_t i) {
  const double scale = 1e-6 + std::max(a.total(), b.total());
  ASSERT_NEAR(a.direct_w_m2, b.direct_w_m2, relative * scale) << i;
  ASSERT_NEAR(a.sky_w_m2, b.sky_w_m2, relative * scale) << i;
  ASSERT_NEAR(a.scattered_w_m2, b.scattered_w_m2, relative * scale) << i;
}

void expect_close(const LightMap& a, const LightMap& b, double relative) {
  ASSERT_EQ(a.bands.size(), b.bands.size());
  for (std::size_t band = 0; band < a.bands.size(); ++band) {
    for (std::size_t i = 0; i < a.bands[band].elements.size(); ++i) {
      expect_close(a.bands[band].elements[i].front, b.bands[band].elements[i].front, relative, i);
      expect_close(a.bands[band].elements[i].back, b.bands[band].elements[i].back, relative, i);
    }
  }
}

class Invariants : public testing::TestWithParam<EnvelopeSun> {
 protected:
  LightMap map(const Forest& forest, const Illumination& light) const {
    return envelope_map(forest, optics_of(forest, {"VIS"}, 0.2), light, GetParam());
  }
  const Forest crown = generated_crown({.leaves = 3000, .crown_lai = 3});
};
INSTANTIATE_TEST_SUITE_P(BothSuns, Invariants,
                         testing::Values(EnvelopeSun::kPublished, EnvelopeSun::kMarched));

TEST_P(Invariants, LinearInTheStrengths) {
  const LightMap one = map(crown, light_of(kSun, 500, 100));
  LightMap scaled = map(crown, light_of(kSun, 5e6, 1e6));
  for (ElementLight& e : scaled.bands[0].elements)
    for (FaceLight* f : {&e.front, &e.back})
      *f = {f->direct_w_m2 * 1e-4f, f->sky_w_m2 * 1e-4f, f->scattered_w_m2 * 1e-4f};
  expect_close(one, scaled, 1e-6);  // floats are stored
}

TEST_P(Invariants, AdditiveInTheSources) {
  const LightMap both = map(crown, light_of(kSun, 500, 100));
  const LightMap sun = map(crown, light_of(kSun, 500, 0)), sky = map(crown, light_of(kSun, 0, 100));
  LightMap sum = sun;
  const auto add = [](FaceLight& a, const FaceLight& b) {
    a = {a.direct_w_m2 + b.direct_w_m2, a.sky_w_m2 + b.sky_w_m2, a.scattered_w_m2 + b.scattered_w_m2};
  };
  for (std::size_t i = 0; i < sum.bands[0].elements.size(); ++i) {
    add(sum.bands[0].elements[i].front, sky.bands[0].elements[i].front);
    add(sum.bands[0].elements[i].back, sky.bands[0].elements[i].back);
  }
  expect_close(both, sum, 1e-6);
}

TEST_P(Invariants, SameFarFromTheOrigin) {
  const LightMap here = map(crown, light_of(kSun, 500, 100));
  for (const double away : {1e4, 1e6}) {
    Forest there = crown;
    there.instances[0].position_m = Vec3(away, 2 * away, away);
    there.terrain.elevation_m = away;
    expect_close(here, map(there, light_of(kSun, 500, 100)), 1e-5);
  }
}

TEST_P(Invariants, TurnsWithTheSceneByAQuarter) {
  // A quarter turn about z takes (x, y) to (-y, x) and octants to octants: the same light on the same leaf.
  const LightMap before = map(crown, light_of(kSun, 500, 100));
  Forest turned = crown;
  turned.instances[0].yaw_rad = static_cast<float>(kPi / 2);
  const LightMap after = map(turned, light_of({-kSun.y, kSun.x, kSun.z}, 500, 100));
  // The yaw is a float, 4e-8 off a quarter turn: so are all cosines.
  expect_close(before, after, 1e-5);
}

TEST_P(Invariants, SameBytesForOneAndTwoThreads) {
  LightMap one, two;
  with_threads(1, [&] { one = map(crown, light_of(kSun, 500, 100)); });
  with_threads(2, [&] { two = map(crown, light_of(kSun, 500, 100)); });
  const auto& a = one.bands[0].elements;
  const auto& b = two.bands[0].elements;
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(ElementLight)), 0);
  EXPECT_EQ(one.sunlit_fraction, two.sunlit_fraction);
  EXPECT_EQ(one.bands[0].mean_irradiance_w_m2, two.bands[0].mean_irradiance_w_m2);
}

TEST_P(Invariants, NothingFromNothing) {
  const LightMap dark = map(crown, light_of(kSun, 0, 0));
  for (const ElementLight& e : dark.bands[0].elements) {
    ASSERT_EQ(e.front.total(), 0.0f);
    ASSERT_EQ(e.back.total(), 0.0f);
  }
}

TEST_P(Invariants, FourReflectancesAreTurnedWithTheLeaf) {
  // Leaves with their faces exchanged, front optics for back optics: the same light on the other face.
  Forest flipped = crown;
  for (FoliageElement& e : flipped.prototypes[0].foliage) std::swap(e.half_u_m, e.half_v_m);
  const LeafOptics leaf{.reflectance_front = 0.5,
                        .reflectance_back = 0.1,
                        .transmittance_front = 0.2,
                        .transmittance_back = 0.3};
  const LeafOptics other{.reflectance_front = 0.1,
                         .reflectance_back = 0.5,
                         .transmittance_front = 0.3,
                         .transmittance_back = 0.2};
  const auto table = [](const Forest& forest, const LeafOptics& optics) {
    return OpticsTable(forest,
                       {.bands = {"VIS"}, .soil_albedo = {0.2}, .overrides = {{"*", "VIS", {optics, 0.1}}}});
  };
  const LightMap a = envelope_map(crown, table(crown, leaf), light_of(kSun, 500, 100), GetParam());
  LightMap b = envelope_map(flipped, table(flipped, other), light_of(kSun, 500, 100), GetParam());
  for (ElementLight& e : b.bands[0].elements) std::swap(e.front, e.back);
  expect_close(a, b, 1e-5);
  EXPECT_NEAR(a.bands[0].trees[0].absorbed_w, b.bands[0].trees[0].absorbed_w,
              1e-5 * a.bands[0].trees[0].absorbed_w);
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
  const LightMap map = envelope_map(forest, optics_of(forest, {"VIS"}, 0.2), light_of(kSun, 500, 100));
  const Provenance& p = map.provenance;
  EXPECT_EQ(p.method, "envelope");
  EXPECT_EQ(p.forest_hash, content_hash(forest));
  EXPECT_FALSE(p.version.empty());
  EXPECT_EQ(p.settings.at(0).second, "marched");
  EXPECT_EQ(p.times.size(), 4u);
  EXPECT_FALSE(map.bands[0].has_budget);
  EXPECT_TRUE(map.bands[0].standard_error_w_m2.empty());
}

TEST(Provenance, SaysWhenBouncesAreMissed) {
  const Forest forest = generated_crown({.leaves = 1500, .crown_lai = 5});
  const LightMap map =
      envelope_map(forest, optics_of(forest, {"PAR", "NIR"}, 0.2), light_of(kSun, 500, 100, 2));
  EXPECT_TRUE(mentions(map.provenance.notes, "band NIR: bounces beyond the first are missing"));
  EXPECT_TRUE(mentions(map.provenance.notes, "a*p = "));
  EXPECT_FALSE(mentions(map.provenance.notes, "band PAR"));  // 0.15 times at most 1
}

TEST(Provenance, SaysWhenLeavesAreFew) {
  const Forest few = generated_crown({.leaves = 299}), enough = generated_crown({.leaves = 301});
  const auto notes = [](const Forest& forest) {
    return envelope_map(forest, optics_of(forest, {"VIS"}, 0.2), light_of(kSun, 1, 1)).provenance.notes;
  };
  EXPECT_TRUE(mentions(notes(few), "has 299 foliage elements"));
  EXPECT_FALSE(mentions(notes(enough), "foliage elements"));
}

TEST(Provenance, SaysWhenCellsAreTooSmall) {
  const Forest forest = generated_crown({.leaves = 1500});
  const OpticsTable optics = optics_of(forest, {"VIS"}, 0.2);
  const LightMap map = envelope_light_map(forest, optics, light_of(kSun, 1, 1), {.cell_m = 0.05}, {});
  EXPECT_TRUE(mentions(map.provenance.notes, "smaller than 2 leaf sides"));
}

TEST(Skips, TheSunWhereThereIsNone) {
  const Forest forest = generated_crown({.leaves = 1500});
  const OpticsTable optics = optics_of(forest, {"VIS"}, 0.2);
  const LightMap night = envelope_map(forest, optics, light_of({1, 0, -0.1}, 500, 100));
  ASSERT_EQ(night.provenance.skipped.size(), 1u);
  EXPECT_EQ(night.provenance.skipped[0].reason, "the sun is not above the horizon");
  EXPECT_EQ(test::mean_direct(night), 0.0);
  for (const float s : night.sunlit_fraction) ASSERT_EQ(s, 0.0f);
  const LightMap cloudy = envelope_map(forest, optics, light_of(kSun, 0, 100));
  ASSERT_EQ(cloudy.provenance.skipped.size(), 1u);
  EXPECT_EQ(cloudy.provenance.skipped[0].reason, "no band has direct sunlight");
  // Both are the light of the sky alone.
  expect_close(night, cloudy, 0.0);
}

// ---- what it refuses
// ---------------------------------------------------------------------------------------

struct BadInput {
  const char* name;
  double cell_m;
  bool leaves;
  Vec3 to_sun;
  std::size_t bands;
  const char *where, *what;
};
const BadInput kBadInputs[] = {{"negative cell", -1, true, {0, 0, 1}, 1, "envelope.cell_m", "-1"},
                               {"cell is no number", NAN, true, {0, 0, 1}, 1, "envelope.cell_m", "nan"},
                               {"infinite cell", INFINITY, true, {0, 0, 1}, 1, "envelope.cell_m", "inf"},
                               {"no leaf", 0, false, {0, 0, 1}, 1, "forest", "no foliage"},
                               {"sun from nowhere", 0, true, {0, 0, 0}, 1, "illumination.to_sun", ""},
                               {"sun is no direction", 0, true, {NAN, 0, 1}, 1, "illumination.to_sun", ""},
                               {"bands do not match", 0, true, {0, 0, 1}, 3, "illumination.bands", ""}};

TEST(BadInput, IsRefusedWithPlaceAndRemedy) {
  for (const BadInput& bad : kBadInputs) {
    const Forest forest = forest_of(bad.leaves ? std::vector{square_leaf({0, 0, 1}, {0, 0, 1}, 0.1)}
                                               : std::vector<FoliageElement>{});
    const OpticsTable optics = optics_of(forest, {"VIS"}, 0.2);
    try {
      envelope_light_map(forest, optics, light_of(bad.to_sun, 1, 1, bad.bands), {.cell_m = bad.cell_m}, {});
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput) << bad.name;
      EXPECT_NE(error.where().find(bad.where), std::string::npos) << bad.name << ": " << error.what();
      EXPECT_NE(error.problem().find(bad.what), std::string::npos) << bad.name << ": " << error.what();
      EXPECT_FALSE(error.remedy().empty()) << bad.name;
    }
  }
}

TEST(Stopping, EndsWithCancelled) {
  const Forest forest = generated_crown({.leaves = 20000});
  std::stop_source source;
  int reports = 0;
  RunControl control;
  control.stop = source.get_token();
  control.progress = [&](std::string_view, double) {
    if (++reports == 3) source.request_stop();
  };
  try {
    envelope_light_map(forest, optics_of(forest, {"VIS"}, 0.2), light_of(kSun, 1, 1), {}, control);
    ADD_FAILURE() << "ran to its end";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
}

}  // namespace
}  // namespace sunfleck
