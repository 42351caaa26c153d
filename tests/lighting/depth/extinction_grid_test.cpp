// Optical depths from the leaf-area grid: closed-form scenes first (Beer's law in a layer and in a sphere,
// one leaf in one cell), then what must never change them: threads, distance from the origin, a slope.
#include "lighting/depth/extinction_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

nlohmann::json case_of(const std::string& id) {
  const auto cases = test::golden("light_cases.json")["cases"];
  for (const auto& c : cases)
    if (c["id"] == id) return c;
  throw std::runtime_error("no case " + id);
}

FoliageElement leaf(const Vec3f& centre, const Vec3f& u, const Vec3f& v) {
  return {.centre_m = centre,
          .half_u_m = 0.5f * u,
          .half_v_m = 0.5f * v,
          .area_m2 = glm::length(glm::cross(u, v))};
}

Forest forest_of(std::vector<FoliageElement> foliage) {
  Forest forest;
  forest.materials = {{"leaf", {{"VIS", 0.25, 0.25, 0.1}}}};
  Prototype& prototype = forest.prototypes.emplace_back();
  prototype.name = "test";
  prototype.materials = {"leaf"};
  prototype.foliage = std::move(foliage);
  forest.instances.push_back({});
  return forest;
}

double mean_transmittance(const ExtinctionGrid& grid, int rays,
                          const std::function<Vec3(RandomStream&)>& start) {
  double sum = 0.0;
  for (int i = 0; i < rays; ++i) {
    RandomStream random(11, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    sum += std::exp(-grid.depth_from_point(start(random), March::kForward));
  }
  return sum / rays;
}

// Intercepted share of a beam by a repeating layer of black leaves with spherical angles is
// 1 - exp(-LAI / (2 cos zenith)). Tolerance 0.01 as in the case file; seeds 1 and 11, no random verdict.
TEST(Layer, InterceptsAsBeerSays) {
  for (const double lai : {0.5, 1.0, 2.0, 3.0, 5.0}) {
    std::ostringstream id;
    id << "beer_spherical_LAI" << lai;
    const auto expected = case_of(id.str())["expected"];
    const Forest forest = generated_layer({.lai = lai, .leaves = 20000, .seed = 1});
    const BlockerField field(forest, {}, {});
    for (const int zenith_deg : {0, 20, 36, 50, 60, 75}) {
      const Vec3 to_sun = direction_from_azimuth_zenith(0.7, radians_from_degrees(zenith_deg));
      const ExtinctionGrid grid(field, -to_sun, {});
      const double through = mean_transmittance(
          grid, 4000, [](RandomStream& r) { return Vec3(r.uniform(-3, 3), r.uniform(-3, 3), 5.0); });
      const double beer = expected["intercept_direct_sza" + std::to_string(zenith_deg)];
      EXPECT_NEAR(1.0 - through, beer, 0.01) << "LAI " << lai << " zenith " << zenith_deg;
    }
  }
}

// Share of the leaf area that sees the sun: (1 - exp(-K)) / K with K = LAI / (2 cos zenith).
TEST(Layer, LightsLeavesAsBeerSays) {
  for (const double lai : {1.0, 3.0}) {
    std::ostringstream id;
    id << "beer_spherical_LAI" << lai;
    const auto expected = case_of(id.str())["expected"];
    const Forest forest = generated_layer({.lai = lai, .leaves = 20000, .seed = 2});
    const BlockerField field(forest, {}, {});
    for (const int zenith_deg : {0, 36, 60, 75}) {
      const ExtinctionGrid grid(field, direction_from_azimuth_zenith(4.0, radians_from_degrees(zenith_deg)),
                                {});
      const auto depths = grid.depth_of_elements(March::kForward, {});
      double lit = 0.0;
      for (const float d : depths) lit += std::exp(-d) / static_cast<double>(depths.size());
      const double beer = expected["sunlit_leaf_area_fraction_sza" + std::to_string(zenith_deg)];
      EXPECT_NEAR(lit, beer, 0.01) << "LAI " << lai << " zenith " << zenith_deg;
    }
  }
}

// Parallel light through a ball of leaves: T = 2 (1 - (1 + K) exp(-K)) / K^2 over its silhouette, K = 3/4
// LAI.
TEST(Sphere, LetsThroughWhatItsChordsDo) {
  for (const int lai : {1, 5}) {
    const auto expected = case_of("sphere_crown_LAI" + std::to_string(lai))["expected"];
    const Forest forest =
        generated_crown({.leaves = 40000, .crown_lai = static_cast<double>(lai), .seed = 3});
    const BlockerField field(forest, {}, {});
    for (const Vec3& direction : {Vec3(0, 0, -1), glm::normalize(Vec3(0.3, -0.5, 0.2)), Vec3(1, 0, 0)}) {
      const ExtinctionGrid grid(field, direction, {});
      const Basis across = basis_around(direction);
      const double through = mean_transmittance(grid, 4000, [&](RandomStream& r) {
        const double radius = std::sqrt(r.uniform()), turn = r.uniform(0, 2 * kPi);
        return Vec3(0, 0, 1.5) - 3.0 * direction + radius * std::cos(turn) * across.tangent +
               radius * std::sin(turn) * across.bitangent;
      });
      EXPECT_NEAR(through, expected["mean_transmittance_of_silhouette"].get<double>(), 0.01) << "LAI " << lai;
    }
  }
}

TEST(OneLeaf, ShadesItsCellButNotItself) {
  // Side 0.1 alone: cells of 0.2, so q = 0.25 seen face on; a ray down through the cell crosses all of it.
  const Forest forest = forest_of({leaf({0, 0, 1}, {0.1f, 0, 0}, {0, 0.1f, 0})});
  const BlockerField field(forest, {}, {});
  EXPECT_NEAR(field.layout().cell_m.x, 0.2, 1e-7);
  const ExtinctionGrid down(field, Vec3(0, 0, -1), {});
  EXPECT_NEAR(down.depth_from_point({0.05, -0.05, 9}, March::kForward), -std::log1p(-0.25), 1e-6);
  EXPECT_EQ(down.depth_from_point({0.5, 0, 9}, March::kForward), 0.0);
  EXPECT_EQ(down.depth_from_point({0, 0, 9}, March::kBackward), 0.0);
  EXPECT_EQ(down.depth_from_element(0, March::kForward), 0.0);
  EXPECT_EQ(down.depth_from_element(0, March::kBackward), 0.0);
  // Edge-on there is nothing to see.
  const ExtinctionGrid level(field, Vec3(1, 0, 0), {});
  EXPECT_EQ(level.depth_from_point({-9, 0, 1}, March::kForward), 0.0);
}

TEST(OneLeaf, KeepsTheDepthOfATwinInTheSamePlace) {
  const FoliageElement one = leaf({0, 0, 1}, {0.1f, 0, 0}, {0, 0.1f, 0});
  const Forest forest = forest_of({one, one});
  const BlockerField field(forest, {}, {});
  const ExtinctionGrid up(field, Vec3(0, 0, 1), {});
  // From the middle of the cell upwards: half of it.
  EXPECT_NEAR(up.depth_from_element(0, March::kForward), -0.5 * std::log1p(-0.25), 1e-6);
  EXPECT_EQ(up.depth_from_element(0, March::kForward), up.depth_from_element(1, March::kForward));
}

TEST(LargeLeaf, IsSpreadOverItsCells) {
  // A 4 m roof over 400 leaves of 0.05 m: its shade reaches all of what lies under it.
  std::vector<FoliageElement> foliage;
  for (int i = 0; i < 400; ++i) {
    RandomStream r(5, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    const Vec3f centre(r.uniform(-1.5, 1.5), r.uniform(-1.5, 1.5), 1.0);
    foliage.push_back(leaf(centre, {0.05f, 0, 0}, {0, 0.05f, 0}));
  }
  foliage.push_back(leaf({0, 0, 3}, {4, 0, 0}, {0, 4, 0}));
  const Forest forest = forest_of(foliage);
  const BlockerField field(forest, {.cell_m = 0.2}, {});
  const ExtinctionGrid up(field, Vec3(0, 0, 1), {});
  EXPECT_FALSE(field.element_pieces().empty());
  EXPECT_GT(up.clamped(), 0u);  // the roof closes cells that count as 0.9 closed
  double least = 1e9;
  for (std::size_t i = 0; i < 400; ++i) least = std::min(least, up.depth_from_element(i, March::kForward));
  // A closed roof shades as 0.9 of a cell's face.
  EXPECT_NEAR(least, -std::log1p(-0.9), 0.01);
  // It does not shade itself by more than neighbouring parts of its own level, none of which lie above it.
  EXPECT_NEAR(up.depth_from_element(400, March::kForward), 0.0, 1e-5);
}

FoliageElement shoot(float needles_m2) {
  return {.centre_m = {0, 0, 1},
          .half_u_m = {0.05f, 0, 0},
          .half_v_m = {0, 0.02f, 0},
          .area_m2 = needles_m2,
          .shape = ElementShape::kShoot};
}

TEST(Shoot, ShadesWithHalfItsNeedleAreaWhenThin) {
  const BlockerField thin(forest_of({shoot(1e-7f)}), {}, {});
  for (const Vec3& w : {Vec3(1, 0, 0), Vec3(0, 0, 1), glm::normalize(Vec3(1, 2, 3))})
    EXPECT_NEAR(projected_area_m2(thin.elements()[0], w), 0.5e-7, 1e-11);
}

TEST(Shoot, ShadesWithItsSilhouetteWhenDense) {
  // Silhouette of the cylinder 0.1 m x 0.04 m: from the side 2 r L, from the end pi r^2.
  const BlockerField dense(forest_of({shoot(1.0f)}), {}, {});
  EXPECT_NEAR(projected_area_m2(dense.elements()[0], Vec3(0, 0, 1)), 0.004, 1e-6);
  EXPECT_NEAR(projected_area_m2(dense.elements()[0], Vec3(1, 0, 0)), kPi * 0.0004, 1e-6);
  EXPECT_NEAR(own_transmittance(dense.elements()[0], Vec3(0, 0, 1)), 0.004 / 0.5, 1e-6);
}

TEST(Wood, ShadesWithItsSilhouette) {
  // A stem of radius 0.1 and 2 m height shades 0.4 m2 from the side, nothing from above.
  Forest forest = forest_of({leaf({0, 1, 1}, {0.1f, 0, 0}, {0, 0.1f, 0})});
  forest.prototypes[0].wood = {
      {.from_m = {0, 0, 0}, .to_m = {0, 0, 2}, .radius_from_m = 0.1f, .radius_to_m = 0.1f}};
  const BlockerField field(forest, {}, {});
  EXPECT_NEAR(projected_area_m2(field.wood()[0], Vec3(1, 0, 0)), 0.4, 1e-7);
  EXPECT_NEAR(projected_area_m2(field.wood()[0], Vec3(0, 0, 1)), 0.0, 1e-12);
  const ExtinctionGrid level(field, Vec3(1, 0, 0), {});
  EXPECT_GT(level.depth_from_point({-5, 0, 1}, March::kForward), 0.5);
  double integral = 0.0;  // extinction times volume is the area it takes from the beam, or more by the log
  for (const float per_m : level.extinction_per_m())
    integral += per_m * std::pow(field.layout().mean_cell_m(), 3);
  EXPECT_GT(integral, 0.4);
}

TEST(Wood, MeshesAreClosedSurfaces) {
  // Two triangles back to back around 0.5 m2: together they shade 0.5 m2.
  Forest forest = forest_of({leaf({0, 2, 1}, {0.1f, 0, 0}, {0, 0.1f, 0})});
  forest.prototypes[0].wood_mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0},
                                    {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 0}};
  const BlockerField field(forest, {}, {});
  double area = 0.0;
  for (const FieldWood& wood : field.wood()) area += projected_area_m2(wood, Vec3(0, 0, 1));
  EXPECT_NEAR(area, 0.5, 1e-7);
}

// 4,000 leaves of 4 mm in a ball of 1 m: cells of 4 sides (16 mm) by the rule alone; 16 cells per leaf are a
// twentieth of the box (8 m3 / 64,000); 1/32 of the box where fewer are asked for. Each to the fit of whole
// cells into the box and the leaves' own draw.
TEST(CellsPerElement, WidenCellsOfManyLeaves) {
  const Forest forest = generated_crown({.leaves = 4000, .crown_lai = 0.02});
  const auto cell_m = [&](double most) {
    return BlockerField(forest, BlockerFieldOptions{.most_cells_per_element = most}, {})
        .layout()
        .mean_cell_m();
  };
  EXPECT_NEAR(cell_m(0), 0.016, 0.001);
  EXPECT_NEAR(cell_m(16), 0.05, 0.002);
  EXPECT_NEAR(cell_m(0.01), 2.0 / 32, 0.003);
  EXPECT_EQ(cell_m(1e6), cell_m(0));
}

TEST(Ground, EndsWhatGoesDownAndHidesWhatLiesBelow) {
  Forest forest =
      forest_of({leaf({0, 0, 1}, {0.1f, 0, 0}, {0, 0.1f, 0}), leaf({0, 0, -1}, {0.1f, 0, 0}, {0, 0.1f, 0})});
  forest.terrain.slope_rad = 0.5;  // falls towards north
  const BlockerField field(forest, {}, {});
  EXPECT_TRUE(field.ends_on_ground({0, 0, -1}));
  EXPECT_FALSE(
      field.ends_on_ground(glm::normalize(Vec3(0, 1, -0.5))));          // downhill, less steep than the slope
  EXPECT_TRUE(field.ends_on_ground(glm::normalize(Vec3(0, -1, 0.5))));  // uphill into the slope
  const ExtinctionGrid up(field, Vec3(0, 0, 1), {});
  EXPECT_EQ(up.depth_from_element(1, March::kForward), kLargestDepth);
  EXPECT_EQ(up.depth_from_element(0, March::kForward), 0.0);
}

// ---- what must not change anything -----------------------------------------------------------------------

std::vector<float> all_depths(const Forest& forest, const Vec3& direction) {
  const BlockerField field(forest, {}, {});
  return ExtinctionGrid(field, direction, {}).depth_of_elements(March::kForward, {});
}

TEST(Invariance, SameBytesForOneAndTwoThreads) {
  const Forest forest = generated_crown({.kind = CrownKind::kClumped, .leaves = 20000});
  std::vector<float> one, two;
  with_threads(1, [&] { one = all_depths(forest, glm::normalize(Vec3(1, 2, 3))); });
  with_threads(2, [&] { two = all_depths(forest, glm::normalize(Vec3(1, 2, 3))); });
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(float)), 0);
}

TEST(Invariance, FarFromTheOrigin) {
  // Positions near 1e6 m are rounded to 1e-10 m: depths change by that over a leaf side, about 1e-8, except
  // where a leaf changes cell (chance 1e-9 each).
  const Forest here = generated_crown({.leaves = 5000});
  const auto expected = all_depths(here, glm::normalize(Vec3(1, -2, 1.5)));
  for (const double away : {1e4, 1e6}) {
    Forest there = here;
    there.instances[0].position_m = Vec3(away, -away, 0.5 * away);
    there.terrain.elevation_m = 0.5 * away;
    const auto depths = all_depths(there, glm::normalize(Vec3(1, -2, 1.5)));
    for (std::size_t i = 0; i < depths.size(); ++i)
      ASSERT_NEAR(depths[i], expected[i], 1e-5) << away << " " << i;
  }
}

TEST(Invariance, ASlopedLayerSeenFromAboveIsTheLevelOne) {
  // Lifting every leaf by the height of the ground under it moves nothing out of a vertical line.
  Forest level = generated_layer({.lai = 3, .leaves = 3000});
  Forest sloped = level;
  sloped.terrain = {.elevation_m = 0, .slope_rad = 0.4, .aspect_rad = 1.1};
  for (FoliageElement& e : sloped.prototypes[0].foliage) {
    e.centre_m.z += static_cast<float>(sloped.terrain.height_at(e.centre_m.x, e.centre_m.y));
  }
  const BlockerField level_field(level, {.cell_m = 0.1}, {}), sloped_field(sloped, {.cell_m = 0.1}, {});
  const ExtinctionGrid a(level_field, Vec3(0, 0, -1), {}), b(sloped_field, Vec3(0, 0, -1), {});
  for (int i = 0; i < 200; ++i) {
    RandomStream r(17, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    const Vec3 p(r.uniform(-4, 4), r.uniform(-4, 4), 50.0);
    EXPECT_NEAR(a.depth_from_point(p, March::kForward), b.depth_from_point(p, March::kForward), 1e-3);
  }
}

TEST(Invariance, ALeafBeyondThePeriodIsWrapped) {
  const auto at = [](float x) {
    Forest forest = forest_of({leaf({x, 0.5f, 1}, {0.1f, 0, 0}, {0, 0.1f, 0}),
                               leaf({0.5f, 0.5f, 0.2f}, {0.1f, 0, 0}, {0, 0.1f, 0})});
    forest.period = Period{.origin_m = {0, 0}, .size_m = {1, 1}};
    return forest;
  };
  for (const float x : {0.5f, 1.5f, -0.5f, 7.5f}) {
    const Forest forest = at(x);
    const BlockerField field(forest, {.cell_m = 0.2}, {});
    const ExtinctionGrid up(field, Vec3(0, 0, 1), {});
    EXPECT_NEAR(up.depth_from_element(1, March::kForward), -std::log1p(-0.25), 1e-3) << x;
  }
}

// ---- edges
// -------------------------------------------------------------------------------------------------

TEST(Edges, LevelAndAxisDirectionsEnd) {
  const Forest layer = generated_layer({.lai = 0.01, .leaves = 50});
  const Forest crown = generated_crown({.leaves = 500});
  for (const Forest* forest : {&layer, &crown}) {
    for (const Vec3& w : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), glm::normalize(Vec3(1, 0, 1e-9)),
                          glm::normalize(Vec3(1, 1e-9, -1e-9)), glm::normalize(Vec3(1e-12, 1, 1e-300))}) {
      for (const float d : all_depths(*forest, w)) {
        ASSERT_TRUE(std::isfinite(d));
        ASSERT_GE(d, 0.0f);
        ASSERT_LE(d, static_cast<float>(kLargestDepth));
      }
    }
  }
}

TEST(Edges, ARayThatMissesSeesNothing) {
  const Forest forest = generated_crown({.leaves = 500});
  const BlockerField field(forest, {}, {});
  const ExtinctionGrid level(field, Vec3(1, 0, 0), {});
  EXPECT_EQ(level.depth_from_point({0, 0, 99}, March::kForward), 0.0);
  EXPECT_EQ(level.depth_from_point({99, 0, 1.5}, March::kForward), 0.0);
  EXPECT_GT(level.depth_from_point({99, 0, 1.5}, March::kBackward), 0.1);
}

TEST(Edges, ScalesFromMillimetresToKilometres) {
  // Optical depth has no unit: a crown and its copy of another size have the same.
  const auto expected = all_depths(generated_crown({.leaves = 2000}), Vec3(0, 0, 1));
  for (const float scale : {1e-3f, 1e3f}) {
    Forest forest = generated_crown({.leaves = 2000});
    forest.instances[0].scale = scale;
    const auto depths = all_depths(forest, Vec3(0, 0, 1));
    std::size_t different = 0;  // a leaf on a cell's face may fall to either side
    for (std::size_t i = 0; i < depths.size(); ++i) different += std::abs(depths[i] - expected[i]) > 1e-3;
    EXPECT_LE(different, 20u) << scale;
  }
}

TEST(Edges, ADenseCrownIsBlackNotInfinite) {
  Forest forest = generated_crown({.leaves = 2000});
  for (FoliageElement& e : forest.prototypes[0].foliage) {
    e.half_u_m *= 30.0f;
    e.half_v_m *= 30.0f;
    e.area_m2 *= 900.0f;
  }
  for (const float d : all_depths(forest, Vec3(0, 0, 1))) {
    ASSERT_GE(d, 0.0f);
    ASSERT_LE(d, static_cast<float>(kLargestDepth));
  }
}

TEST(Edges, StopsWhenAsked) {
  const Forest forest = generated_crown({.leaves = 20000});
  std::stop_source source;
  source.request_stop();
  const RunControl stopped{.stop = source.get_token(), .progress = {}};
  EXPECT_THROW(BlockerField(forest, {}, stopped), Error);
  const BlockerField field(forest, {}, {});
  EXPECT_THROW(ExtinctionGrid(field, Vec3(0, 0, 1), stopped), Error);
}

}  // namespace
}  // namespace sunfleck
