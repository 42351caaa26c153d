// A sky that is brighter around the sun, through every method: light on a lone leaf is known on paper.
#include <gtest/gtest.h>

#include "lighting/plan/light_request.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

LightRequest clear_sky(const std::string& method) {
  LightRequest request;
  request.method = method_from_string(method, "test");
  request.optics = {{"PAR"}, {0.0}, {}};
  request.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(180), radians_from_degrees(50));
  request.light.sky = SkyModel::kPerez;
  request.light.sky_clearness = 6;
  request.light.sky_brightness = 0.15;
  request.light.bands = {{0, 100}};
  return request;
}

double mean_of(const Forest& forest, const std::string& method, const SkyModel sky) {
  LightRequest request = clear_sky(method);
  request.light.sky = sky;
  return compute_light_map(forest, request, {1}, {}).bands[0].mean_irradiance_w_m2;
}

// A clear sky is no overcast one: on leaves in a loose crown the light changes, and every method that knows
// azimuths agrees with the reference on how.
TEST(PerezSky, EveryMethodAnswersAndFollowsTheReference) {
  const Forest forest = generated_crown({.leaves = 1500, .crown_lai = 1});
  const double truth = mean_of(forest, "reference", SkyModel::kPerez);
  const double overcast = mean_of(forest, "reference", SkyModel::kStandardOvercast);
  EXPECT_GT(std::abs(truth / overcast - 1), 0.05);
  for (const std::string& method : method_names()) {
    const double mean = mean_of(forest, method, SkyModel::kPerez);
    EXPECT_GT(mean, 0) << method;
    // The slab and eight-direction methods see zenith angles only, or few azimuths.
    EXPECT_NEAR(mean / truth, 1, method == "reference" || method == "auto" || method == "grid" ? 0.05 : 0.3)
        << method;
  }
}

}  // namespace
}  // namespace sunfleck
