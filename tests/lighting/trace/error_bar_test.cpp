// Standard errors must mean what they say: over many seeds, (value - mean over the seeds) / standard error
// has variance 1, for elements, trees and means, and the energy residual lies around 0 by its own error.
// Seeds 1 to 256: the outcome is fixed.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

constexpr int kSeeds = 256;

// Two trees of unlike size on bright ground, sun and sky, many bounces.
Forest two_trees() {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 1.5}, Vec3(1), 150, 0.2, 11), {Leaf{0.45, 0.35, 0.3}});
  forest.prototypes[0].wood.push_back({{0, 0, 0}, {0, 0, 1.5f}, 0.08f, 0.03f, 0});
  forest.instances.push_back({{1.4, 0.3, 0}, {}, 1.0f, 0.7f, {}});
  return forest;
}

// Sum over seeds of squared deviations from the mean over the seeds, against the variances claimed.
struct Calibration {
  double squares = 0, claimed = 0, z_squares = 0, terms = 0;
  void add(const std::vector<double>& values, const std::vector<double>& errors) {
    const auto n = static_cast<double>(values.size());
    double mean = 0.0;
    for (const double v : values) mean += v / n;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double square = (values[i] - mean) * (values[i] - mean) * n / (n - 1.0);
      squares += square;
      claimed += errors[i] * errors[i];
      z_squares += square / (errors[i] * errors[i]);
      terms += 1.0;
    }
  }
  double ratio() const { return squares / claimed; }
  double z_variance() const { return z_squares / terms; }
};

struct Runs {
  std::vector<LightMap> maps;
};

Runs runs(const Illumination& light, int rays, int sun_rays, int seeds = kSeeds) {
  const Forest forest = two_trees();
  Runs r;
  for (int s = 1; s <= seeds; ++s) {
    ReferenceOptions o;
    o.seed = static_cast<std::uint64_t>(s);
    o.rays_per_face = rays;
    o.sun_rays_per_element = sun_rays;
    r.maps.push_back(trace_light(forest, 0.3, light, o));
  }
  return r;
}

Calibration of_elements(const Runs& r) {
  Calibration c;
  for (std::size_t e = 0; e < r.maps[0].bands[0].elements.size(); ++e) {
    std::vector<double> values, errors;
    for (const LightMap& m : r.maps) {
      const ElementLight& light = m.bands[0].elements[e];
      values.push_back(static_cast<double>(light.front.total()) + light.back.total());
      errors.push_back(m.bands[0].standard_error_w_m2[e]);
    }
    c.add(values, errors);
  }
  return c;
}

Calibration of_tree(const Runs& r, std::size_t tree) {
  Calibration c;
  std::vector<double> values, errors;
  for (const LightMap& m : r.maps) {
    values.push_back(m.bands[0].trees[tree].absorbed_w);
    errors.push_back(m.bands[0].trees[tree].absorbed_standard_error_w);
  }
  c.add(values, errors);
  return c;
}

Calibration of_mean(const Runs& r) {
  Calibration c;
  std::vector<double> values, errors;
  for (const LightMap& m : r.maps) {
    values.push_back(m.bands[0].mean_irradiance_w_m2);
    errors.push_back(m.bands[0].mean_irradiance_standard_error_w_m2);
  }
  c.add(values, errors);
  return c;
}

void expect_near_one(double variance, const char* what) {
  EXPECT_GT(variance, 0.8) << what;
  EXPECT_LT(variance, 1.25) << what;
}

void expect_calibrated(const Runs& r) {
  expect_near_one(of_elements(r).ratio(), "squares of elements, summed");
  expect_near_one(of_elements(r).z_variance(), "z of elements");
  // 256 seeds and the tails of Student's t with 7 degrees of freedom: these scatter by 12 %.
  expect_near_one(of_tree(r, 0).z_variance(), "z of the large tree");
  expect_near_one(of_tree(r, 1).z_variance(), "z of the small tree");
  expect_near_one(of_mean(r).z_variance(), "z of the mean irradiance");
  double squares = 0.0;
  for (const LightMap& m : r.maps)
    squares += std::pow(m.bands[0].budget.residual_w / m.bands[0].budget.residual_standard_error_w, 2);
  EXPECT_GT(squares / kSeeds, 0.6) << "z of the energy residual around 0";
  EXPECT_LT(squares / kSeeds, 1.4) << "z of the energy residual around 0";
}

TEST(ErrorBars, SkyWithManyBounces) { expect_calibrated(runs(skylight(100.0), 32, 1)); }

// Two sequences of two rays. The rays of an element fall short of their spread, which is pooled over all.
// 1024 seeds: trees and means scatter by 6 %.
TEST(ErrorBars, FewRays) {
  const Runs r = runs(sunlight({1, 1, 2}, 400.0, 100.0), 4, 4, 1024);
  expect_near_one(of_elements(r).ratio(), "squares of elements, summed");
  for (const Calibration& c : {of_tree(r, 0), of_tree(r, 1), of_mean(r)})
    expect_near_one(c.z_variance(), "z of trees and mean");
}

TEST(ErrorBars, SunAndSky) { expect_calibrated(runs(sunlight({1, 1, 2}, 400.0, 100.0), 64, 32)); }

}  // namespace
}  // namespace sunfleck::test
