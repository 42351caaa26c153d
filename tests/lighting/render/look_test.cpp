// Leaf outlines, textures, gloss and patterns: what they show, and that they keep area and light.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "lighting/render/image_difference.h"
#include "lighting/render/material_look.h"
#include "lighting/render/render_config.h"
#include "lighting/render/surface.h"
#include "lighting/render/tone_map.h"
#include "sim/base/error.h"
#include "sim/plant/flat_elements.h"
#include "tests/lighting/render/render_scene.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;
using test::camera_above;
using test::parallelogram;
using test::RenderScene;

constexpr std::array kOutlines = {LeafOutline::kOvate, LeafOutline::kLobed, LeafOutline::kNeedle};

// Grey pixels 0 .. 255, top row first.
fs::path write_png(const char* name, int width, int height, int channels,
                   const std::vector<std::uint8_t>& bytes) {
  const fs::path path = test::scratch_dir() / name;
  const auto output = OIIO::ImageOutput::create("png");
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  EXPECT_TRUE(output->open(path.string(), spec));
  EXPECT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, bytes.data()));
  EXPECT_TRUE(output->close());
  return path;
}

TEST(LeafOutline, ShareIsTheAreaInside) {
  for (const LeafOutline outline : kOutlines) {
    int inside = 0;
    double reflect = 0, pass = 0;
    constexpr int kSide = 1000;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const Vec2 at(2 * (i + 0.5) / kSide - 1, 2 * (j + 0.5) / kSide - 1);
        if (!inside_leaf(outline, at)) continue;
        ++inside;
        reflect += vein_pattern(outline, at).reflect;
        pass += vein_pattern(outline, at).pass;
      }
    // A rim of about four box sides is uncertain by half a cell: 4 / 1000 / sqrt(12) at worst.
    EXPECT_NEAR(outline_share(outline), inside / 1e6, 2e-3) << to_string(outline);
    EXPECT_NEAR(reflect / inside, 1.0, 2e-3);  // another lattice than the one the mean was taken on
    EXPECT_NEAR(pass / inside, 1.0, 2e-3);
    EXPECT_GT(outline_share(outline), 0.3);
    EXPECT_LT(outline_share(outline), 1.0);
  }
  EXPECT_EQ(outline_of("Quercus robur"), LeafOutline::kLobed);
  EXPECT_EQ(outline_of("Picea abies"), LeafOutline::kNeedle);
  EXPECT_EQ(outline_of("Fagus sylvatica"), LeafOutline::kOvate);
}

// Level leaves seen from above: the share of the picture that shows them is their area, whatever their form.
TEST(LeafOutline, KeepsTheLeafsArea) {
  FoliageElement rhombus = parallelogram({0, 0, 5}, {0.5f, -0.25f, 0}, {0.5f, 0.25f, 0});
  const FoliageElement square = parallelogram({0, 0, 5}, {0.37f, 0.15f, 0}, {-0.15f, 0.37f, 0});
  const FoliageElement disc = make_disc({0, 0, 5}, {0, 0, 1}, 0.4);
  for (const FoliageElement& leaf : {rhombus, square, disc})
    for (const LeafOutline outline : {LeafOutline::kAsModelled, LeafOutline::kOvate, LeafOutline::kLobed}) {
      RenderScene scene;
      scene.leaves() = {leaf};
      scene.look.outline = outline;
      const Image image = scene.render(camera_above(4, 256));
      const double seen_m2 =
          std::count(image.instance_id.begin(), image.instance_id.end(), 0.0f) * std::pow(4 / 256.0, 2);
      EXPECT_NEAR(seen_m2, leaf.area_m2, 0.02 * leaf.area_m2) << to_string(outline);  // rim pixels
    }
}

// The tip of a grammar's leaf lies at centre + half_u + half_v, its base stays where it was.
TEST(LeafOutline, PointsAlongTheLeaf) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, 0, 5}, {0.5f, -0.25f, 0}, {0.5f, 0.25f, 0})};
  scene.look.outline = LeafOutline::kOvate;
  const Image image = scene.render(camera_above(4, 256));
  double left = 256, right = 0, widest_x = 0;
  std::array<int, 256> in_column{};
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x)
      if (image.instance_id[test::pixel_at(image, x, y)] == 0.0f) {
        ++in_column[static_cast<std::size_t>(x)];
        left = std::min(left, x + 0.5), right = std::max(right, x + 0.5);
      }
  widest_x = static_cast<double>(std::max_element(in_column.begin(), in_column.end()) - in_column.begin());
  EXPECT_NEAR(left, 64, 2);                   // base at x = -1 m
  EXPECT_LT(widest_x, 0.5 * (left + right));  // egg-shaped: widest nearer the base
}

// Light passes the cut-away parts: the shadow on the ground is as large as the leaf, in both ways.
TEST(LeafOutline, CastsItsOwnShadow) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, 0, 5}, {0.5f, 0, 0}, {0, 0.5f, 0})};
  scene.override_leaf({});
  scene.look.outline = LeafOutline::kLobed;
  scene.light.to_sun = glm::normalize(Vec3(1, 0, 1));
  scene.light.bands = {{300.0, 0.0}};
  Camera camera = camera_above(8, 128);
  camera.position_m = {-5, 0, 20}, camera.look_at_m = {-5, 0, 0};
  for (const Image& image : {scene.render(camera), scene.render_path_traced(camera)}) {
    double dark_m2 = 0;
    for (std::size_t p = 0; p < image.depth_m.size(); ++p) dark_m2 += image.rgb[3 * p] == 0.0f;
    EXPECT_NEAR(dark_m2 * std::pow(8 / 128.0, 2), 1.0, 0.05);
  }
}

TEST(Textures, AlphaImagesCutLeavesOut) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, 0, 5}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0})};
  // The upper half of the image (towards the tip, +x) is leaf.
  MaterialTextures textures;
  textures.leaf_alpha = write_png("alpha.png", 2, 4, 1, {255, 255, 255, 255, 0, 0, 0, 0});
  scene.look.textures = {textures};
  const Image image = scene.render(camera_above(4, 256));
  const double seen_m2 =
      std::count(image.instance_id.begin(), image.instance_id.end(), 0.0f) * std::pow(4 / 256.0, 2);
  EXPECT_NEAR(seen_m2, 2.0, 0.06);
  const test::Patch patch = test::patch_of(image, 0.0f);
  EXPECT_GT(patch.x_px, 140);  // right of the middle
}

// Left is left: an image whose left half is white, right half black, seen from the front with the tip up.
TEST(Textures, ImagesStandUprightAndKeepTheMean) {
  RenderScene scene;
  scene.leaves() = {parallelogram({0, 0, 5}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0})};  // tip towards north
  MaterialTextures textures;
  textures.leaf_alpha = write_png("opaque.png", 2, 2, 1, {255, 255, 255, 255});
  textures.leaf_reflectance = write_png("halves.png", 2, 1, 1, {255, 0});
  scene.look.textures = {textures};
  scene.override_leaf({0.3, 0.3, 0, 0});
  scene.front = {0, 100, 0};
  Camera camera = camera_above(1.2, 64);
  camera.samples_per_pixel = 16;
  const Image image = scene.render(camera);
  double left = 0, right = 0, sum = 0, count = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const std::size_t p = test::pixel_at(image, x, y);
      if (image.instance_id[p] != 0.0f) continue;
      (x < 32 ? left : right) += image.rgb[3 * p];
      sum += image.rgb[3 * p], count += 1;
    }
  EXPECT_GT(left, 3 * right);
  EXPECT_NEAR(sum / count, 0.3 * 100 / kPi, 0.03 * 0.3 * 100 / kPi);  // rim pixels hold some ground
}

TEST(Textures, ThickPartsLetLessThrough) {
  MaterialTextures textures;
  textures.leaf_alpha = write_png("opaque2.png", 2, 2, 1, {255, 255, 255, 255});
  textures.leaf_thickness = write_png("thick.png", 1, 2, 1, {0, 255});  // thin tip, thick base
  const MaterialLook look(PictureLook{}, "leaf", &textures);
  // exp(-2 thickness): ends of the image's range are its pixel centres.
  EXPECT_NEAR(look.leaf_pass({0.9, 0}).x / look.leaf_pass({-0.9, 0}).x, std::exp(2.0), 1e-3);
  double mean = 0;
  for (int i = 0; i < 1000; ++i) mean += look.leaf_pass({2 * (i + 0.5) / 1000 - 1, 0.1}).x / 1000;
  EXPECT_NEAR(mean, 1.0, 1e-3);
}

TEST(Textures, FilesThatCannotBeReadAreNamedWithTheirKey) {
  const fs::path text = test::scratch_dir() / "not_an_image.png";
  { std::ofstream(text) << "this is no image"; }
  const fs::path empty = write_png("transparent.png", 1, 1, 1, {0});
  for (const auto& [path, says] : {std::pair{text, "cannot be read"},
                                   {fs::path("/no/such.png"), "no file"},
                                   {empty, "transparent everywhere"}}) {
    const ConfigTable table = ConfigTable::from_text(
        "[[textures]]\nmaterial = \"leaf\"\nleaf_alpha = \"" + path.string() + "\"\n", "scene.toml");
    RenderScene scene;
    scene.look = read_render_settings(table).look;
    scene.leaves() = {parallelogram({0, 0, 5}, {0.5f, 0, 0}, {0, 0.5f, 0})};
    try {
      scene.render(camera_above(4, 8));
      ADD_FAILURE() << path << " was accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.where()).find("scene.toml"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      EXPECT_NE(error.problem().find(path.filename().string()), std::string::npos);
    }
  }
}

// The lobe reflects all at normal incidence: integral of (n + 2) / (2 pi) cos^n cos over the hemisphere is 1.
TEST(Gloss, TakesNothingMoreThanItIsGiven) {
  Surface s;
  s.reflect = Vec3(1.0);
  s.gloss = 1.0;
  for (const double zenith_deg : {0.0, 40.0, 80.0}) {
    const Vec3 view = direction_from_azimuth_zenith(1.0, radians_from_degrees(zenith_deg));
    double sum = 0;
    constexpr int kRings = 200, kSectors = 400;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kSectors; ++j) {
        const double z = (i + 0.5) / kRings, across = std::sqrt(1 - z * z),
                     turn = 2 * kPi * (j + 0.5) / kSectors;
        const Vec3 w(across * std::cos(turn), across * std::sin(turn), z);
        sum += scattering(s, w, view).x * z * 2 * kPi / (kRings * kSectors);
      }
    if (zenith_deg == 0.0) {
      EXPECT_NEAR(sum, 1.0, 1e-3);
    }
    EXPECT_LE(sum, 1.001);
    EXPECT_GT(sum, 0.2);
  }
}

TEST(RenderConfig, ReadsEveryKeyAndRefusesOthers) {
  const auto read = [](const char* text) {
    return read_render_settings(ConfigTable::from_text(text, "s.toml"));
  };
  const RenderSettings s = read(
      "mode = \"path_traced\"\nnoise = 0.02\nmax_samples_per_pixel = 100\nleaf_sun = "
      "\"stored\"\nleaf_outline = "
      "\"lobed\"\npatterns = false\nleaf_gloss = 0.2\nground = \"grass\"\ngloss_exponent = 30\nbark_width_m "
      "= 1\ntone = "
      "\"filmic\"\n"
      "exposure_stops = 0.5\n[[textures]]\nmaterial = \"Fagus sylvatica\"\nbark = \"bark.png\"\n");
  EXPECT_EQ(s.mode, RenderMode::kPathTraced);
  EXPECT_EQ(s.effort.noise, 0.02);
  EXPECT_EQ(s.effort.max_samples_per_pixel, 100);
  EXPECT_EQ(s.leaf_sun, LeafSun::kStored);
  EXPECT_EQ(s.look.outline, LeafOutline::kLobed);
  EXPECT_FALSE(s.look.patterns);
  EXPECT_EQ(s.look.textures.at(0).bark, fs::path("bark.png"));
  EXPECT_EQ(s.tone.curve, ToneCurve::kFilmic);
  EXPECT_THROW(read("mode = \"fast\"\n"), Error);
  EXPECT_THROW(read("noise = 2\n"), Error);
  EXPECT_THROW(read("[[textures]]\nleaf_alpha = 3\n"), Error);
  const ConfigTable unknown = ConfigTable::from_text("noize = 0.1\n", "s.toml");
  read_render_settings(unknown);
  EXPECT_THROW(unknown.reject_unread(), Error);
}

// Even pictures a, b: only the term of the means is left, (2 a b + .0001) / (a^2 + b^2 + .0001). A picture
// against its own mirror image in grey has a negative covariance equal to its variance: the term of structure
// is near -1.
TEST(StructuralSimilarity, KnownValues) {
  const std::vector<double> a(400, 0.5), b(400, 0.6);
  EXPECT_NEAR(structural_similarity(a, a, 20, 20), 1.0, 1e-12);
  EXPECT_NEAR(structural_similarity(a, b, 20, 20), (2 * 0.3 + 1e-4) / (0.25 + 0.36 + 1e-4), 1e-12);
  std::vector<double> board(400), other(400);
  for (std::size_t i = 0; i < 400; ++i) board[i] = (i + i / 20) % 2 ? 0.9 : 0.1, other[i] = 1.0 - board[i];
  EXPECT_NEAR(structural_similarity(board, other, 20, 20), -(2 * 0.16 - 9e-4) / (2 * 0.16 + 9e-4), 1e-3);
}

// One grey level of 7: the middle, .16, through the curve is (.16 (2.51 .16 + .03)) / (.16 (2.43 .16 + .59) +
// .14) = 0.2329, in sRGB 1.055 .2329^(1/2.4) - .055 = 0.5200, of 255 = 133.
TEST(ToneMap, FilmicPutsTheMiddleInTheMiddle) {
  Image image;
  image.rgb.assign(30, 7.0f);
  EXPECT_EQ(tone_mapped(image, {ToneCurve::kFilmic, 0.0})[0], 133);
  const auto brighter = tone_mapped(image, {ToneCurve::kFilmic, 1.0});
  EXPECT_GT(brighter[0], 160);
  image.rgb[0] = 1e9f;
  EXPECT_EQ(tone_mapped(image, {ToneCurve::kFilmic, 0.0})[0], 255);
  EXPECT_EQ(tone_mapped(image, {ToneCurve::kLinear, -1.0})[0], 188);  // half of white
}

}  // namespace
}  // namespace sunfleck
