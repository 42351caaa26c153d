// Bidirectional reflectance: a Lambertian plane, and six of the 76 angles of RAMI HET01 beside the published
// ones (all of them: tests/bench/render/het01_bench.cpp).
#include <gtest/gtest.h>

#include "sim/base/error.h"
#include "tests/lighting/render/het01.h"

namespace sunfleck {
namespace {

TEST(Reflectance, OfBareSoilIsItsAlbedo) {
  Forest forest;
  forest.period = Period{{0, 0}, {10, 10}};
  const OpticsTable optics(forest, {.bands = {"nir"}, .soil_albedo = {0.3}, .overrides = {}});
  const std::vector<Vec3> views = {{0, 0, 1}, test::principal_plane(60)};
  for (const ReflectanceFactor& f :
       bidirectional_reflectance(forest, optics, test::principal_plane(-40), views,
                                 {.samples_per_view = 64, .look = plain_look()}, {}))
    EXPECT_NEAR(f.value, 0.3, 1e-9);
}

TEST(Reflectance, BadDirectionsAreNamed) {
  Forest forest;
  const OpticsTable optics(forest, {.bands = {"nir"}, .soil_albedo = {0.3}, .overrides = {}});
  const std::vector<Vec3> up = {{0, 0, 1}}, down = {{0, 0, -1}};
  EXPECT_THROW(bidirectional_reflectance(forest, optics, {0, 0, -1}, up, {}, {}), Error);
  EXPECT_THROW(bidirectional_reflectance(forest, optics, {0, 0, 1}, down, {}, {}), Error);
  EXPECT_THROW(bidirectional_reflectance(forest, optics, {0, 0, 1}, up, {}, {}), Error);  // empty, no period
}

// 32,768 paths leave a noise of 0.55 %; 1 % is what the case allows on top of four of those.
TEST(Reflectance, OfHet01) {
  const auto forest = test::het01();
  if (!forest) GTEST_SKIP() << "no shared data";
  const test::Het01Case expected = test::het01_case();
  std::vector<Vec3> views;
  std::vector<double> wanted;
  for (const double angle : {-75.0, -45.0, -21.0, -19.0, 1.0, 55.0})
    for (std::size_t i = 0; i < expected.factor.size(); ++i)
      if (expected.view_zenith_deg[i] == angle) {
        views.push_back(test::principal_plane(angle));
        wanted.push_back(expected.factor[i]);
      }
  ASSERT_EQ(views.size(), 6u);
  const auto found =
      bidirectional_reflectance(*forest, test::het01_optics(*forest), test::principal_plane(-20), views,
                                {.samples_per_view = 32768, .look = plain_look()}, {});
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::printf("%.5f +- %.5f expected %.5f\n", found[i].value, found[i].standard_error, wanted[i]);
    EXPECT_NEAR(found[i].value, wanted[i], 0.01 * wanted[i] + 4 * found[i].standard_error);
    EXPECT_LT(found[i].standard_error, 0.01 * wanted[i]);
  }
}

}  // namespace
}  // namespace sunfleck
