// Small pictures kept as numbers (tests/golden/pictures.json: red, green, blue and standard error of every
// pixel), compared by their mean and by z per pixel, not by bytes: another order of random numbers is fine,
// another picture is not. SUNFLECK_WRITE_GOLDEN=FILE in the environment writes them anew, with 64 times the
// samples.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/lighting/render/bush_scene.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

constexpr int kSamples = 64;

// The bush with everything a picture can show: outlines, veins, bark, litter, gloss.
test::RenderScene dressed_bush() {
  test::RenderScene scene = test::traced_bush();
  scene.look = PictureLook{};
  scene.look.leaf_gloss = 0.2;
  return scene;
}

Image picture(const test::RenderScene& scene, bool traced, int samples) {
  Camera camera = test::bush_view(samples);
  camera.width_px = 18, camera.height_px = 12;
  camera.seed = 5;
  return traced ? scene.render_path_traced(camera)
                : test::rendered(scene, test::reference_map(scene), camera);
}

const char* name_of(bool traced) { return traced ? "path_traced" : "light_map"; }

TEST(GoldenPictures, MeanAndEveryPixelAgree) {
  const test::RenderScene scene = dressed_bush();
  if (const char* path = std::getenv("SUNFLECK_WRITE_GOLDEN")) {
    nlohmann::json all;
    for (const bool traced : {false, true}) {
      const Image image = picture(scene, traced, 64 * kSamples);
      all[name_of(traced)] = {{"rgb", image.rgb}, {"standard_error", image.rgb_standard_error}};
    }
    std::ofstream(path) << all.dump();
    GTEST_SKIP() << "wrote " << path;
  }
  const nlohmann::json golden = test::golden("pictures.json");
  for (const bool traced : {false, true}) {
    Image expected;
    expected.rgb = golden[name_of(traced)]["rgb"].get<std::vector<float>>();
    expected.rgb_standard_error = golden[name_of(traced)]["standard_error"].get<std::vector<float>>();
    expected.depth_m.resize(expected.rgb_standard_error.size());
    const Image image = picture(scene, traced, kSamples);
    ASSERT_EQ(image.rgb.size(), expected.rgb.size());
    double z2 = 0, variance = 0;
    const auto n = static_cast<double>(expected.depth_m.size());
    for (std::size_t p = 0; p < expected.depth_m.size(); ++p) {
      const double v = std::pow(image.rgb_standard_error[p], 2) + std::pow(expected.rgb_standard_error[p], 2);
      variance += v;
      // The sky's pixels have no noise; a hundredth of a per cent stands for rounding.
      z2 += std::pow(test::grey_at(image, p) - test::grey_at(expected, p), 2) /
            (v + std::pow(1e-4 * test::grey_at(expected, p), 2));
    }
    // 216 pixels of 15 degrees of freedom: the mean of z^2 is 15 / 13 +- 0.12 where all are noisy, less where
    // some are not; 4 standard deviations on top.
    EXPECT_LT(z2 / n, 1.65) << name_of(traced);
    EXPECT_GT(z2 / n, 0.3) << name_of(traced);
    EXPECT_NEAR(test::mean_grey(image), test::mean_grey(expected), 4 * std::sqrt(variance) / n);
  }
}

}  // namespace
}  // namespace sunfleck
