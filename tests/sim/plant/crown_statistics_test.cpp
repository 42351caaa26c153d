// Crown volume, even filling and leaf angles against independent sums. Seeds are fixed; the chance that a
// right program fails with another seed stands at each test.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "sim/plant/crown_shape.h"
#include "tests/sim/plant/crown_fixture.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

// The crown as the inventory describes it, written apart from the code under test: at height z the section
// has in each quadrant the polar radius of an ellipse, shrunk by sqrt(1 - t^2), t = way to top or base.
bool in_crown_by_polar_radius(const CrownShape& crown, const Vec3& p) {
  const double up = crown.height_m - crown.widest_m, down = crown.widest_m - crown.base_m;
  const double t = p.z >= crown.widest_m ? (p.z - crown.widest_m) / up : (crown.widest_m - p.z) / down;
  if (t > 1) return false;
  const double ns = p.y > 0 ? crown.radius_nesw_m[0] : crown.radius_nesw_m[2];
  const double ew = p.x > 0 ? crown.radius_nesw_m[1] : crown.radius_nesw_m[3];
  const double turn = std::atan2(p.y, p.x);
  const double rim = ns * ew / std::hypot(ns * std::cos(turn), ew * std::sin(turn));
  return std::hypot(p.x, p.y) <= rim * std::sqrt(1 - t * t);
}

TEST(CrownVolume, OfASpheroidIsTheTextbookOne) {
  CrownShape crown = test::crooked_crown();
  crown.radius_nesw_m = {3, 3, 3, 3};
  EXPECT_NEAR(crown_volume_m3(crown), 4.0 / 3.0 * kPi * 3 * 3 * 6, 1e-9);  // semi-axes 3, 3, (18 - 6)/2
}

// 400,000 points in the crown's box; 4.5 standard errors, chance of a false alarm 7e-6. The own inside test
// is tied to inside_crown on the way.
TEST(CrownVolume, AgreesWithMonteCarlo) {
  const CrownShape crown = test::crooked_crown();
  const Vec3 lo(-4, -1.5, 6), size(6, 4.5, 12);
  constexpr int kPoints = 400000;
  int inside = 0;
  RandomStream random(11, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 p = lo + size * Vec3(random.uniform(), random.uniform(), random.uniform());
    const bool is_inside = in_crown_by_polar_radius(crown, p);
    inside += is_inside;
    ASSERT_TRUE(!is_inside || inside_crown(crown, p, 1e-9));
  }
  const double share = double(inside) / kPoints, box_m3 = size.x * size.y * size.z;
  const double standard_error = std::sqrt(share * (1 - share) / kPoints);
  EXPECT_NEAR(crown_volume_m3(crown) / box_m3, share, 4.5 * standard_error);
}

double chi_square(const std::vector<int>& counts) {
  double total = 0, sum = 0;
  for (const int n : counts) total += n;
  const double expected = total / double(counts.size());
  for (const int n : counts) sum += (n - expected) * (n - expected) / expected;
  return sum;
}

// Scaled into the unit ball, an even filling has radius^3, |cos(zenith)| and the azimuth within the quadrant
// uniform. Chi-square over 20 classes each: 64.4 is exceeded with a chance of 1e-6. Without stem, above
// ground, so that nothing is left out.
TEST(CrownFilling, IsEvenInEveryDirectionAndDepth) {
  CrownShape crown = test::crooked_crown();
  crown.dbh_m = 0;
  const Prototype tree = crown_prototype(test::broadleaf(), crown, {60, 50000, 17});
  std::vector<int> by_radius(20), by_height(20), by_azimuth(20), by_eighth(8);
  const auto count = [](std::vector<int>& classes, double share) {
    ++classes[std::min<std::size_t>(19, static_cast<std::size_t>(20 * share))];
  };
  for (const FoliageElement& e : tree.foliage) {
    const Vec3 p = Vec3(e.centre_m) - Vec3(0, 0, crown.widest_m);
    const auto& r = crown.radius_nesw_m;
    const Vec3 q = glm::abs(p / Vec3(p.x > 0 ? r[1] : r[3], p.y > 0 ? r[0] : r[2], p.z > 0 ? 9 : 3));
    count(by_radius, std::pow(glm::length(q), 3));
    count(by_height, q.z / glm::length(q));
    count(by_azimuth, std::atan2(q.y, q.x) / (0.5 * kPi));
    ++by_eighth[(p.x > 0 ? 1u : 0u) + (p.y > 0 ? 2u : 0u) + (p.z > 0 ? 4u : 0u)];
  }
  EXPECT_LT(chi_square(by_radius), 64.4);
  EXPECT_LT(chi_square(by_height), 64.4);
  EXPECT_LT(chi_square(by_azimuth), 64.4);
  const auto eighths = crown_eighths(crown);
  for (std::size_t i = 0; i < 8; ++i)  // stratified: exact but for the element on a border, twice
    EXPECT_NEAR(by_eighth[i], 50000 * eighths[i].volume_m3 / crown_volume_m3(crown), 2.0);
}

// Mean |cos| between beam and normals of 20,000 leaves against the analytic G-function. 40 comparisons at 4
// standard errors: chance of a false alarm 40 * 6.3e-5 = 0.3 %.
TEST(LeafAngles, GFunctionOfTheLeavesIsThatOfTheDistribution) {
  const std::map<std::string, LeafAngles> names = {{"spherical", LeafAngles::kSpherical},
                                                   {"planophile", LeafAngles::kPlanophile},
                                                   {"erectophile", LeafAngles::kErectophile},
                                                   {"plagiophile", LeafAngles::kPlagiophile},
                                                   {"uniform_inclination", LeafAngles::kUniform}};
  const nlohmann::json all = test::golden("light_cases.json").at("cases");
  const auto found =
      std::find_if(all.begin(), all.end(), [](const auto& c) { return c.at("id") == "G_function_deWit"; });
  ASSERT_NE(found, all.end());
  const auto zeniths_deg = found->at("inputs").at("zenith_deg").get<std::vector<double>>();
  for (const auto& [name, angles] : names) {
    const Prototype tree = crown_prototype(test::broadleaf(angles), test::crooked_crown(), {60, 20000, 23});
    const auto expected = found->at("expected").at(name).get<std::vector<double>>();
    for (std::size_t k = 0; k < zeniths_deg.size(); ++k) {
      const Vec3 beam = direction_from_azimuth_zenith(0.7, radians_from_degrees(zeniths_deg[k]));
      double sum = 0, squares = 0;
      for (const FoliageElement& e : tree.foliage) {
        const double c = std::abs(glm::dot(element_normal(e), beam));
        sum += c;
        squares += c * c;
      }
      const double n = double(tree.foliage.size()), mean = sum / n;
      EXPECT_NEAR(mean, expected[k], 4 * std::sqrt((squares / n - mean * mean) / n))
          << name << zeniths_deg[k];
    }
  }
}

// Axes of shoots with spherical normals point everywhere alike: |cos| to any direction is uniform on [0, 1],
// mean 1/2, standard deviation 1/sqrt(12). Three directions at 4.5 standard errors: false alarm 2e-5.
TEST(LeafAngles, SphericalShootAxesPointEverywhere) {
  const Prototype tree = crown_prototype(test::conifer(), test::crooked_crown(), {60, 20000, 29});
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0.6, 0.8)}) {
    double sum = 0;
    for (const FoliageElement& e : tree.foliage)
      sum += std::abs(glm::dot(glm::normalize(Vec3(e.half_u_m)), direction));
    EXPECT_NEAR(sum / 20000, 0.5, 4.5 / std::sqrt(12.0 * 20000));
  }
}

}  // namespace
}  // namespace sunfleck
