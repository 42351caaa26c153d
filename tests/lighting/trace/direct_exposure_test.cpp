// The cheaper way to direct sun: all elements are drawn, a few of many get rays; both agree.
#include "lighting/trace/direct_exposure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/forest/generated_scenes.h"

namespace sunfleck::test {
namespace {

Illumination sun() {
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.45, 0.25, 0.86));
  return light;
}

TEST(DirectExposure, DrawsAllAndCastsRaysToFew) {
  const Forest forest = generated_crown({.leaves = 20000});
  const ForestIndex index(forest);
  const ProbeScene scene(forest, true, {});
  std::vector<std::size_t> few;
  for (std::size_t e = 0; e < 20000; e += 500) few.push_back(e);
  const DirectExposure all =
      direct_sun_exposure(forest, index, &scene, sun(), {}, {.target_error = 0.03}, {});
  const DirectExposure some =
      direct_sun_exposure(forest, index, &scene, sun(), few, {.target_error = 0.03}, {});
  EXPECT_TRUE(all.by_raster);
  EXPECT_FALSE(some.by_raster) << some.reason;
  EXPECT_GT(some.rays, 64);
  double chi2 = 0;
  for (const std::size_t e : few)
    chi2 += std::pow(all.sun.sunlit_fraction[e] - some.sun.sunlit_fraction[e], 2) /
            (std::pow(all.sun.standard_error[e], 2) + std::pow(some.sun.standard_error[e], 2)) /
            static_cast<double>(few.size());
  EXPECT_LT(chi2, 2.0);  // 40 elements with heavy tails
}

TEST(DirectExposure, CostsGrowWithWhatIsAsked) {
  const Forest forest = generated_crown({.leaves = 20000});
  const ForestIndex index(forest);
  const double coarse = estimate_raster_cost(forest, index, 0, {.target_error = 0.2}).cpu_s;
  const RasterCost fine = estimate_raster_cost(forest, index, 0, {.target_error = 0.02});
  EXPECT_GT(fine.cpu_s, coarse);
  EXPECT_LT(fine.pixel_m, 0.005);
  EXPECT_GT(shadow_rays_for(0.02), 4 * shadow_rays_for(0.1));
  EXPECT_GT(estimate_shadow_ray_cost(forest, index, 20000, 64, true), fine.cpu_s);
  EXPECT_GT(estimate_shadow_ray_cost(forest, index, 10, 64, false),
            estimate_shadow_ray_cost(forest, index, 10, 64, true));
}

}  // namespace
}  // namespace sunfleck::test
