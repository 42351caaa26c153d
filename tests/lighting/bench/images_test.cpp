// The yardstick of pictures: figures of pictures whose error is known on paper, and a small scene whose table
// must hang together.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "lighting/bench/image_scenes.h"
#include "lighting/bench/image_tables.h"
#include "sim/base/error.h"
#include "sim/base/random.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

constexpr int kSide = 64;

// Radiance 1 everywhere plus an even offset and normal noise.
Image grey_picture(double offset, double noise, std::uint64_t seed) {
  Image image;
  image.width_px = image.height_px = kSide;
  RandomStream random(seed, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 3 * kSide * kSide; ++i)
    image.rgb.push_back(static_cast<float>(1.0 + offset + noise * random.normal()));
  return image;
}

// 12,288 numbers: a sample standard deviation is known to 1 / sqrt(2 * 12288) = .6 %; 4 of that.
constexpr double kSpread = 0.026;

TEST(ImageFigures, NoiseOfTheTruthIsTakenOut) {
  const ImageTruth truth = image_truth(grey_picture(0, 0.2, 1), grey_picture(0, 0.2, 2));
  EXPECT_NEAR(truth.noise, 0.2 / std::sqrt(2.0), kSpread * 0.15);
  const std::vector<Image> repeats = {grey_picture(0, 0.1, 3), grey_picture(0, 0.1, 4)};
  const ImageFigures f = compare(truth, repeats);
  // The square to be found is .01 and .02 is subtracted, whose sampling error is .02 * sqrt(2 / 12288)
  // = 2.6e-4 (each): 4 of these, on a root of .1, are .0065.
  EXPECT_NEAR(f.rmse, 0.1, 0.0065);
  EXPECT_NEAR(f.noise, 0.1, kSpread * 0.1);
  EXPECT_LT(std::fabs(f.bias), 4 * f.bias_standard_error);
}

TEST(ImageFigures, OffsetIsBiasAndFloor) {
  const ImageTruth truth = image_truth(grey_picture(0, 0.02, 1), grey_picture(0, 0.02, 2));
  const std::vector<Image> repeats = {grey_picture(-0.3, 0.04, 3), grey_picture(-0.3, 0.04, 4)};
  const ImageFigures f = compare(truth, repeats);
  EXPECT_NEAR(f.bias, -0.3, 4 * f.bias_standard_error);
  // Noise of the truth's mean .02 / sqrt(2), of the pictures' mean .04 / sqrt(2), grey over three channels.
  EXPECT_NEAR(f.bias_standard_error, std::sqrt((2e-4 + 8e-4) / 3) / kSide, 0.1 * f.bias_standard_error);
  EXPECT_NEAR(f.floor, 0.3, 0.003);
  EXPECT_NEAR(f.rmse * f.rmse, f.floor * f.floor + f.noise * f.noise, 1e-12);
}

TEST(ImageFigures, TheTruthItselfHasNoError) {
  const Image picture = grey_picture(0, 0.1, 1);
  const ImageTruth truth = image_truth(picture, picture);
  const ImageFigures f = compare(truth, std::vector<Image>{picture, picture});
  EXPECT_EQ(f.bias, 0);
  EXPECT_EQ(f.rmse, 0);
  EXPECT_EQ(f.noise, 0);
  EXPECT_NEAR(f.ssim, 1, 1e-12);
  EXPECT_NEAR(f.flip, 0, 1e-12);
}

TEST(ImageFigures, TheSunsDiscDoesNotCount) {
  Image picture = grey_picture(0, 0.01, 1), other = picture;
  for (std::size_t c = 0; c < 3; ++c) picture.rgb[c] = 1e5f, other.rgb[c] = 2e5f;
  const ImageTruth truth = image_truth(picture, picture);
  EXPECT_NEAR(truth.brightness, 1, 0.01);
  EXPECT_EQ(compare(truth, std::vector<Image>{other, other}).rmse, 0);
}

ImageRow row(const char* way, int samples, double rmse, double cpu_s) {
  ImageRow r;
  r.scene = "s", r.way = way, r.samples = samples, r.error.rmse = rmse, r.cpu_s = cpu_s;
  return r;
}

TEST(ImageRows, AreComparedAtEqualTimeAndEqualError) {
  // Path tracing: 1 s to prepare, .5 s per sample, error .4 / sqrt(samples).
  std::vector<ImageRow> rows = {row("path_traced", 1, 0.4, 1.5), row("path_traced", 16, 0.1, 9),
                                row("cheap", 4, 0.1, 3), row("hasty", 1, 0.4, 0.9), row("exact", 1, 0, 5)};
  compare_with_path_tracing(rows);
  for (const int i : {0, 1}) {
    EXPECT_NEAR(rows[i].times_cheaper_at_equal_error, 1, 1e-12);
    EXPECT_NEAR(rows[i].path_traced_rmse_at_equal_time, rows[i].error.rmse, 1e-12);
  }
  EXPECT_NEAR(rows[2].times_cheaper_at_equal_error, 9.0 / 3.0, 1e-12);
  EXPECT_NEAR(rows[2].path_traced_rmse_at_equal_time, 0.4 / std::sqrt(4.0), 1e-12);  // (3 - 1) / .5 samples
  EXPECT_NEAR(rows[3].times_cheaper_at_equal_error, 1.5 / 0.9, 1e-12);
  EXPECT_TRUE(std::isnan(rows[3].path_traced_rmse_at_equal_time));  // still preparing
  EXPECT_TRUE(std::isnan(rows[4].times_cheaper_at_equal_error));
}

ImageTask small_bush() {
  const auto scenes =
      choose_image_scenes(image_scenes(1, test::source_dir() / "configs" / "species"), "bush");
  ImageTask task = scenes.front().make({});
  task.camera.width_px = task.camera.height_px = 32;
  task.light.reference.rays_per_face = task.light.reference.sun_rays_per_element = 16;
  task.ways = image_ways({});
  return task;
}

TEST(ImageErrors, TableOfASmallSceneHangsTogether) {
  const ImageTask task = small_bush();
  ImagePlan plan;
  plan.samples = {1, 4, 16};
  plan.reference_samples = 256;
  std::vector<std::string> refused;
  const ImageBenchmark benchmark = image_errors(task, plan, refused, {});
  EXPECT_TRUE(refused.empty());
  ASSERT_EQ(benchmark.rows.size(), plan.samples.size() * task.ways.size());
  EXPECT_EQ(benchmark.light_map_method, "reference");
  for (std::size_t i = 0; i < benchmark.rows.size(); ++i) {
    const ImageRow& r = benchmark.rows[i];
    EXPECT_EQ(r.samples, plan.samples[i % plan.samples.size()]);
    EXPECT_GT(r.cpu_s, 0);
    EXPECT_GT(r.error.rmse, 0);
    EXPECT_GT(r.error.ssim, 0.2);
    EXPECT_GT(r.error.flip, 0);
    // Four times as many independent samples halve the noise; from 4 to 16 they come in units of four
    // low-discrepancy samples, which take up to a third more away. Two repeats know a ratio to 3 %.
    if (i % plan.samples.size() > 0) {
      const double ratio = benchmark.rows[i - 1].error.noise / r.error.noise;
      EXPECT_GT(ratio, 1.8) << r.way;
      EXPECT_LT(ratio, 3.0) << r.way;
    }
  }
  // Path tracing has no error but noise: what is left is below a third of it, the rest of two noisy squares.
  const ImageRow& last = benchmark.rows[plan.samples.size() - 1];
  EXPECT_LT(last.error.floor, 0.34 * last.error.noise);
  EXPECT_LT(std::fabs(last.error.bias), 5 * last.error.bias_standard_error);
}

TEST(ImageErrors, OfPathTracingWithItsOwnTruthAreNoiseAlone) {
  ImageTask task = small_bush();
  task.ways.resize(1);
  ImagePlan plan;
  plan.samples = {128};
  plan.reference_samples = 256;  // halves as long as the picture: the same error
  std::vector<std::string> refused;
  const ImageBenchmark benchmark = image_errors(task, plan, refused, {});
  const ImageRow& r = benchmark.rows.front();
  EXPECT_NEAR(r.error.rmse / (benchmark.reference_noise * std::sqrt(2.0)), 1, 0.15);
  EXPECT_TRUE(benchmark.light_map_method.empty());
  EXPECT_TRUE(std::isnan(r.times_cheaper_at_equal_error));  // one number of samples tells no time per sample
}

TEST(ImageErrors, StopAndBlindCamerasAreTold) {
  ImageTask task = small_bush();
  std::stop_source stop;
  stop.request_stop();
  std::vector<std::string> refused;
  RunControl control;
  control.stop = stop.get_token();
  EXPECT_THROW(image_errors(task, {}, refused, control), Error);
  task.camera.position_m.z = -5;
  EXPECT_THROW(image_errors(task, {}, refused, {}), Error);
}

TEST(ImageScenes, AreChosenByName) {
  const auto scenes = image_scenes(1, test::source_dir() / "configs" / "species");
  EXPECT_EQ(choose_image_scenes(scenes, "all").size(), scenes.size());
  EXPECT_EQ(choose_image_scenes(scenes, "quick").size(), 2u);
  EXPECT_THROW(choose_image_scenes(scenes, "moon"), Error);
  EXPECT_THROW(choose_image_scenes(scenes, ""), Error);
  const ImageTask far = choose_image_scenes(scenes, "far_crowns").front().make({});
  EXPECT_EQ(far.forest.instances.size(), 400u);
  EXPECT_NO_THROW(validate(far.forest));
}

TEST(ImageWays, AreATableThatStartsWithPathTracing) {
  const auto ways = image_ways({});
  EXPECT_EQ(ways.front().name, "path_traced");
  EXPECT_EQ(ways.front().settings.mode, RenderMode::kPathTraced);
  EXPECT_EQ(choose_image_ways(ways, "light_map").size(), 2u);
  EXPECT_EQ(choose_image_ways(ways, "all").size(), ways.size());
  EXPECT_THROW(choose_image_ways(ways, "magic"), Error);
  EXPECT_THROW(choose_image_ways(ways, ""), Error);
}

std::size_t fields(const std::string& line) {
  bool inside = false;
  std::size_t count = 1;
  for (const char c : line) {
    if (c == '"') inside = !inside;
    count += !inside && c == ',';
  }
  return count;
}

TEST(ImageTables, HaveAsManyFieldsAsNamesAndAPanelPerScene) {
  ImageBenchmark benchmark;
  benchmark.rows = {row("path_traced", 1, 0.4, 1.5), row("cheap", 1, 0.0, 1.0)};
  benchmark.rows.back().times_cheaper_at_equal_error = std::nan("");
  std::istringstream csv(image_csv({benchmark, benchmark}, 1, machine_facts()));
  std::string names, line;
  std::getline(csv, names);
  std::size_t lines = 0;
  for (; std::getline(csv, line); ++lines) EXPECT_EQ(fields(line), fields(names));
  EXPECT_EQ(lines, 4u);
  EXPECT_EQ(image_page({benchmark, benchmark}, machine_facts()).panels.size(), 2u);
  EXPECT_NE(image_table(benchmark).find("path_traced"), std::string::npos);
}

}  // namespace
}  // namespace sunfleck
