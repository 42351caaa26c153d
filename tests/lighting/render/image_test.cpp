// Pictures as files, and how rendering behaves: tiles, threads, stopping.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "tests/lighting/render/render_scene.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;
using test::parallelogram;
using test::RenderScene;

// A leafy bush with wood, sun, sky and shade: every kind of shading draws random numbers.
RenderScene bush() {
  RenderScene scene;
  scene.use_band("PAR");
  RandomStream random(9, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < 500; ++i) {
    const auto number = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
    scene.leaves().push_back(
        parallelogram({number(-2, 2), number(-2, 2), number(1, 5)}, {0.1f, 0, 0.05f}, {0, 0.1f, 0}));
  }
  scene.wood() = {{{0, 0, 0}, {0, 0, 4}, 0.2f, 0.1f, 0}};
  scene.front = {50, 20, 5};
  scene.light.to_sun = glm::normalize(Vec3(1, -1, 2));
  scene.light.sun_half_angle_rad = 0.0046;
  scene.light.bands = {{300.0, 100.0}};
  return scene;
}

Camera bush_camera() {
  Camera camera;
  camera.position_m = {0, -10, 4};
  camera.look_at_m = {0, 0, 3};
  camera.width_px = 150;
  camera.height_px = 100;
  return camera;
}

// Distinct values everywhere; infinite depth in one pixel.
Image numbered_image() {
  Image image;
  image.width_px = 5;
  image.height_px = 3;
  for (int p = 0; p < 15; ++p) {
    const auto f = static_cast<float>(p);
    image.rgb.insert(image.rgb.end(), {f + 0.1f, f + 0.2f, 1e6f + f});
    image.rgb_standard_error.push_back(0.01f * f);
    image.depth_m.push_back(p == 7 ? std::numeric_limits<float>::infinity() : 100.0f / (f + 1));
    image.normal.insert(image.normal.end(), {f / 15, -f / 15, 1 - f / 15});
    image.instance_id.push_back(1000003.0f * f - 1);
    image.irradiance_w_m2.push_back(f * f);
  }
  return image;
}

TEST(Exr, HasTheLayersAndKeepsEveryBit) {
  const Image image = numbered_image();
  const fs::path path = test::scratch_dir() / "picture.exr";
  save_exr(image, path);
  const auto input = OIIO::ImageInput::open(path.string());
  ASSERT_TRUE(input);
  const OIIO::ImageSpec spec = input->spec();
  EXPECT_EQ(spec.width, 5);
  EXPECT_EQ(spec.height, 3);
  ASSERT_EQ(spec.nchannels, 10);
  std::vector<float> pixels(15 * 10);
  ASSERT_TRUE(input->read_image(0, 0, 0, 10, OIIO::TypeDesc::FLOAT, pixels.data()));
  const auto expect_layer = [&](const char* name, const std::vector<float>& values, std::size_t stride,
                                std::size_t offset) {
    const int channel = spec.channelindex(name);
    ASSERT_GE(channel, 0) << name;
    for (std::size_t p = 0; p < 15; ++p)
      EXPECT_EQ(pixels[10 * p + static_cast<std::size_t>(channel)], values[stride * p + offset])
          << name << " pixel " << p;
  };
  expect_layer("R", image.rgb, 3, 0);
  expect_layer("G", image.rgb, 3, 1);
  expect_layer("B", image.rgb, 3, 2);
  expect_layer("depth.Z", image.depth_m, 1, 0);
  expect_layer("normal.X", image.normal, 3, 0);
  expect_layer("normal.Y", image.normal, 3, 1);
  expect_layer("normal.Z", image.normal, 3, 2);
  expect_layer("instance.id", image.instance_id, 1, 0);
  expect_layer("irradiance.Y", image.irradiance_w_m2, 1, 0);
  expect_layer("error.Y", image.rgb_standard_error, 1, 0);
}

// 200 pixels of 0.5, 50 of 1, one of 1000: the 99th percentile is 1, so 1 is white, 1000 too, and 0.5 is
// 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354 of 255 = 188.
TEST(Png, The99thPercentileIsWhite) {
  Image image;
  image.width_px = 251;
  image.height_px = 1;
  image.depth_m.assign(251, 1.0f);
  for (int p = 0; p < 251; ++p) {
    const float value = p < 200 ? 0.5f : p < 250 ? 1.0f : 1000.0f;
    image.rgb.insert(image.rgb.end(), {value, value, value});
  }
  const fs::path path = test::scratch_dir() / "picture.png";
  save_png(image, path);
  const auto input = OIIO::ImageInput::open(path.string());
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().width, 251);
  EXPECT_EQ(input->spec().height, 1);
  ASSERT_EQ(input->spec().nchannels, 3);
  std::vector<std::uint8_t> bytes(251 * 3);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
  EXPECT_EQ(bytes[0], 188);
  EXPECT_EQ(bytes[3 * 220], 255);
  EXPECT_EQ(bytes[3 * 250], 255);
}

TEST(Png, ABlackPictureIsBlack) {
  Image image = numbered_image();
  std::fill(image.rgb.begin(), image.rgb.end(), 0.0f);
  const fs::path path = test::scratch_dir() / "black.png";
  save_png(image, path);
  EXPECT_TRUE(OIIO::ImageInput::open(path.string()));
}

TEST(ImageFiles, UnwritablePathsAreNamedAndNothingIsLeft) {
  const fs::path folder = test::scratch_dir() / "images";
  fs::create_directories(folder / "taken.png");
  using Save = void (*)(const Image&, const fs::path&);
  for (const Save save : {Save{save_exr}, Save{save_png}})
    for (const char* name : {"taken.png", "no_such_folder/picture.png"}) {
      const fs::path path = folder / name;
      try {
        save(numbered_image(), path);
        ADD_FAILURE() << path;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kInputOutput) << error.what();
        EXPECT_EQ(error.where(), path.string());
      }
    }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST(Render, IsTheSameForAnyNumberOfThreads) {
  const RenderScene scene = bush();
  Image one, two;
  with_threads(1, [&] { one = scene.render(bush_camera()); });
  with_threads(2, [&] { two = scene.render(bush_camera()); });
  EXPECT_EQ(one.rgb, two.rgb);
  EXPECT_EQ(one.rgb_standard_error, two.rgb_standard_error);
  EXPECT_EQ(one.depth_m, two.depth_m);
  EXPECT_EQ(one.normal, two.normal);
  EXPECT_EQ(one.instance_id, two.instance_id);
  Camera other_seed = bush_camera();
  other_seed.seed = 2;
  EXPECT_NE(scene.render(other_seed).rgb, one.rgb);
}

TEST(Render, TilesCoverThePictureOnceAndComeOneAtATime) {
  const RenderScene scene = bush();
  std::vector<int> covered(150 * 100, 0);
  std::atomic<int> inside{0};
  double last_progress = 0;
  RunControl control;
  control.progress = [&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "rendering");
    last_progress = fraction;
  };
  const Image image =
      scene.render(bush_camera(), control, [&](const Image& so_far, int x0, int y0, int x1, int y1) {
        EXPECT_EQ(++inside, 1);
        EXPECT_LE(x1 - x0, 64);
        EXPECT_LE(y1 - y0, 64);
        EXPECT_EQ(so_far.rgb.size(), covered.size() * 3);
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x) ++covered[test::pixel_at(so_far, x, y)];
        --inside;
      });
  for (const int count : covered) ASSERT_EQ(count, 1);
  EXPECT_EQ(last_progress, 1.0);
}

// 4096 samples in each of 15,000 pixels take minutes; stopped from outside it ends at once.
TEST(Render, StopsWhenAsked) {
  const RenderScene scene = bush();
  Camera camera = bush_camera();
  camera.samples_per_pixel = 4096;
  std::stop_source source;
  RunControl control;
  control.stop = source.get_token();
  std::chrono::steady_clock::time_point asked;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    asked = std::chrono::steady_clock::now();
    source.request_stop();
  });
  try {
    scene.render(camera, control);
    ADD_FAILURE() << "was not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
  const auto stopped = std::chrono::steady_clock::now();
  stopper.join();
  const double waited_s = std::chrono::duration<double>(stopped - asked).count();
  std::printf("stopped after %.1f ms\n", 1e3 * waited_s);
  EXPECT_LT(waited_s, 1.0);  // 10 ms is the aim; loose for shared machines and slow builds
}

}  // namespace
}  // namespace sunfleck
