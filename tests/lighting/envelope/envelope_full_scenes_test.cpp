// envelope_full on scenes whose answer is known on paper, and single leaves and points against the whole map.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/envelope/envelope_suitability.h"
#include "sim/base/error.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/envelope/scenes.h"

namespace sunfleck {
namespace {

using test::envelope_full_map;
using test::forest_of;
using test::light_of;
using test::optics_of;
using test::square_leaf;

class EverySet : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Directions, EverySet, testing::Values(8, 14, 26, 50));

TEST_P(EverySet, OneLeafBetweenSkyAndWhiteGroundGetsTheSameOnBothFaces) {
  // Uniform sky and a ground of albedo 1 without sun: radiance 100 / pi from everywhere. The ground a sector
  // ends on lies in the leaf's own shade along the opposite sector, and that counts for the whole sector: at
  // most the share of one of 8 sectors times what a leaf takes from its cell, 4 %.
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.2, -0.4, 0.1), Vec3(1, 1, -1)}) {
    const Forest forest = forest_of({square_leaf({0, 0, 3}, normal, 0.1)});
    const LightMap map = envelope_full_map(forest, optics_of(forest, {"VIS"}, 1.0),
                                           light_of({0, 0, 1}, 0, 100), {.directions = GetParam()});
    EXPECT_NEAR(map.bands[0].elements[0].front.total(), 100.0, 4.0) << normal.x << " " << normal.z;
    EXPECT_NEAR(map.bands[0].elements[0].back.total(), 100.0, 4.0);
  }
}

TEST_P(EverySet, LevelLeafUnderUniformSky) {
  // Weights are scaled to pi per leaf; only level sectors, half of which is sky, are shared with the back.
  const Forest forest = forest_of({square_leaf({0, 0, 1}, {0, 0, 1}, 0.1)});
  const LightMap map = envelope_full_map(forest, optics_of(forest, {"VIS"}, 0.0), light_of({0, 0, 1}, 0, 100),
                                         {.directions = GetParam()});
  EXPECT_NEAR(map.bands[0].elements[0].front.sky_w_m2, 100.0, 3.0);
  EXPECT_NEAR(map.bands[0].elements[0].back.sky_w_m2, 0.0, 3.0);
  EXPECT_EQ(map.bands[0].elements[0].front.scattered_w_m2, 0.0f);
}

TEST(OneLeafFull, SeesTheSunOnTheGroundButNotInItsOwnShade) {
  const Forest forest = forest_of({square_leaf({0, 0, 3}, {0, 0, 1}, 0.1)});
  const Vec3 to_sun = direction_from_azimuth_zenith(1.0, radians_from_degrees(60));
  const LightMap map =
      envelope_full_map(forest, optics_of(forest, {"VIS"}, 0.2), light_of(to_sun, 800, 100), {});
  EXPECT_NEAR(map.bands[0].elements[0].back.scattered_w_m2, 0.2 * (100 + 800 * 0.5), 2.0);
  EXPECT_NEAR(map.bands[0].elements[0].front.direct_w_m2, 400.0, 1e-3);
}

// Mean sunlit share of a ball: see envelope_scenes_test.cpp.
double sunlit_share_of_ball(double lai) {
  const double k = 0.75 * lai, t = 2 * (1 - (1 + k) * std::exp(-k)) / (k * k);
  return (1 - t) / (0.5 * lai);
}

TEST(BallFull, SkyAllAroundIsSunFromEverywhere) {
  for (const double lai : {2.0, 5.0}) {
    const Forest forest = generated_crown({.leaves = 20000, .crown_lai = lai, .seed = 6});
    EnvelopeFullOptions options;
    options.ground = EnvelopeGround::kFullyLit;
    options.bounces = EnvelopeBounces::kSunOnce;  // no sun: nothing but the two backgrounds
    const LightMap map =
        envelope_full_map(forest, optics_of(forest, {"VIS"}, 1.0), light_of({0, 0, 1}, 0, 100), options);
    const double all_around = test::mean_sky(map) + test::mean_scattered(map);
    // As much as envelope_marched: 3 % for cells and directions.
    EXPECT_NEAR(all_around / (200.0 * sunlit_share_of_ball(lai)), 1.0, 0.03) << lai;
  }
}

TEST(BallFull, FurnaceIsNearlyClosed) {
  // Leaves that absorb nothing over white ground under an even sky: 100 on every face, whatever stands in the
  // way. The local bounces reach it within some percent on average, which is their error, not rounding.
  for (const double lai : {1.0, 3.0, 6.0}) {
    const Forest forest = generated_crown({.leaves = 6000, .crown_lai = lai, .seed = 6});
    const LeafOptics white{0.5, 0.5, 0.5, 0.5};
    const OpticsTable optics(
        forest, {.bands = {"VIS"}, .soil_albedo = {1.0}, .overrides = {{"*", "VIS", {white, 1.0}}}});
    const LightMap map = envelope_full_map(forest, optics, light_of({0, 0, 1}, 0, 100), {});
    const double mean = 0.5 * (test::mean_sky(map) + test::mean_scattered(map));
    std::cout << "furnace, LAI " << lai << ": " << mean << " of 100\n";
    EXPECT_NEAR(mean, 100.0, 12.0) << lai;
  }
}

TEST(LayerFull, GroundUnderACanopyIsDark) {
  // Layer of LAI 4: the sun at the zenith reaches the ground by exp(-2), leaves' backs must see that little
  // of it. Black leaves; backs see ground through the leaves below them only.
  const Forest forest = generated_layer({.lai = 4, .leaves = 8000, .seed = 2});
  const OpticsTable optics(
      forest, {.bands = {"VIS"}, .soil_albedo = {0.5}, .overrides = {{"*", "VIS", {LeafOptics{}, 0.0}}}});
  EnvelopeFullOptions lit;
  lit.ground = EnvelopeGround::kFullyLit;
  const double shaded =
      test::mean_scattered(envelope_full_map(forest, optics, light_of({0, 0, 1}, 1000, 0), {}));
  const double fully =
      test::mean_scattered(envelope_full_map(forest, optics, light_of({0, 0, 1}, 1000, 0), lit));
  // Mean of exp(-depth) over cells of the layer is above exp of the mean: 20 %.
  EXPECT_NEAR(shaded / fully, std::exp(-2.0), 0.2 * std::exp(-2.0));
}

class Queries : public testing::Test {
 protected:
  const Forest forest = generated_crown({.leaves = 2000, .crown_lai = 3, .seed = 9});
  const OpticsTable optics = optics_of(forest, {"PAR", "NIR"}, 0.2);
  const Illumination light = light_of({0.3, -0.5, 0.6}, 500, 100, 2);
};

TEST_F(Queries, OfElementsAreTheMap) {
  const EnvelopePrepared prepared = prepare_envelope(forest, {}, {});
  const LightMap map = envelope_full_light_map(forest, optics, light, prepared, {});
  const EnvelopeQuery query(forest, optics, light, prepared, {});
  for (std::size_t i = 0; i < 2000; i += 37) {
    const EnvelopeAnswer answer = query.at_element(i);
    EXPECT_EQ(static_cast<float>(answer.sunlit), map.sunlit_fraction[i]);
    EXPECT_GE(answer.recollision, 0.0);
    EXPECT_LT(answer.recollision, 1.0);
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_EQ(answer.bands[b].front.total(), map.bands[b].elements[i].front.total());
      EXPECT_EQ(answer.bands[b].back.total(), map.bands[b].elements[i].back.total());
    }
  }
}

TEST_F(Queries, OfPointsAreLeavesThatKeepTheirOwnShade) {
  EnvelopeFullOptions options;
  options.own_leaf = EnvelopeOwnLeaf::kKept;
  const EnvelopePrepared prepared = prepare_envelope(forest, options, {});
  const EnvelopeQuery query(forest, optics, light, prepared, {});
  std::vector<EnvelopePoint> points;
  for (std::size_t i = 0; i < 2000; i += 37) {
    const WorldElement e = world_element(forest, 0, i);
    points.push_back(
        {.position_m = e.centre_m, .normal = glm::cross(e.half_u_m, e.half_v_m), .neighbours = {}});
  }
  const auto answers = envelope_at(forest, optics, light, prepared, points, {});
  for (std::size_t k = 0; k < points.size(); ++k) {
    const EnvelopeAnswer leaf = query.at_element(37 * k);
    // Positions are stored as floats in the field: depths move by 1e-5.
    EXPECT_NEAR(answers[k].bands[1].front.total(), leaf.bands[1].front.total(), 1e-3 * 600) << k;
    EXPECT_NEAR(answers[k].bands[1].back.total(), leaf.bands[1].back.total(), 1e-3 * 600) << k;
  }
}

TEST_F(Queries, OutsideTheCrownSeeAllTheSky) {
  const EnvelopePrepared prepared = prepare_envelope(forest, {}, {});
  const EnvelopeQuery query(forest, optics, light_of({0, 0, 1}, 0, 100, 2), prepared, {});
  const EnvelopeAnswer above =
      query.at_point({.position_m = {0, 0, 50}, .normal = {0, 0, 1}, .neighbours = {}});
  EXPECT_NEAR(above.bands[0].front.sky_w_m2, 100.0, 3.0);
  EXPECT_NEAR(above.recollision, 0.0, 1.0 / 15);  // the sector straight down meets the crown
}

TEST_F(Queries, RefuseWhatIsNoPoint) {
  const EnvelopePrepared prepared = prepare_envelope(forest, {}, {});
  const EnvelopeQuery query(forest, optics, light, prepared, {});
  EXPECT_THROW(query.at_point({.position_m = {0, 0, NAN}, .normal = {0, 0, 1}, .neighbours = {}}), Error);
  EXPECT_THROW(query.at_point({.position_m = {0, 0, 1}, .normal = {0, 0, 0}, .neighbours = {}}), Error);
  EXPECT_THROW(query.at_point({.position_m = {0, 0, 1}, .normal = {0, 0, 1}, .neighbours = {7}}), Error);
}

const EnvelopeCondition& condition(const EnvelopeSuitability& s, const std::string& name) {
  for (const EnvelopeCondition& c : s.conditions)
    if (c.name == name) return c;
  throw std::runtime_error("no condition " + name);
}

EnvelopeSuitability suitability(const Forest& forest, EnvelopeFullOptions options = {}) {
  return envelope_suitability(forest, optics_of(forest, {"NIR"}, 0.2), prepare_envelope(forest, options, {}));
}

TEST(Suitability, TellsWhichConditionBreaks) {
  EXPECT_TRUE(suitability(generated_crown({.leaves = 5000})).suitable);
  const EnvelopeSuitability few = suitability(generated_crown({.leaves = 100}));
  EXPECT_FALSE(few.suitable);
  EXPECT_FALSE(condition(few, "fewest_elements").met);
  EXPECT_EQ(condition(few, "fewest_elements").value, 100);
  EnvelopeFullOptions fine;
  fine.cell_m = 0.05;
  EXPECT_FALSE(condition(suitability(generated_crown({.leaves = 1500}), fine), "cell_sides").met);
  EXPECT_FALSE(condition(suitability(generated_layer({.lai = 3})), "light_spread").met);
}

TEST(Suitability, ForcedAnswersSayTheyAreOutside) {
  const Forest forest = generated_crown({.leaves = 100});
  const LightMap map =
      envelope_full_map(forest, optics_of(forest, {"NIR"}, 0.2), light_of({0, 0, 1}, 1, 1), {});
  ASSERT_FALSE(map.provenance.notes.empty());
  EXPECT_NE(map.provenance.notes[0].find("outside its range (fewest_elements 100"), std::string::npos);
}

}  // namespace
}  // namespace sunfleck
