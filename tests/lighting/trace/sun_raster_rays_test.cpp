// The picture of the sun against shadow rays, and its standard errors against what it really errs by. Truth:
// 1024 rays from points of every sampled element, spread over leaves, random in shoots; their own variance
// (at most 1/4 / 1024) is part of what is expected. Seeds are fixed.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting/trace/probe_light.h"
#include "lighting/trace/probe_sun.h"
#include "lighting/trace/sun_raster.h"
#include "sim/base/random.h"
#include "sim/forest/forest_spec.h"
#include "sim/forest/generated_scenes.h"
#include "tests/lighting/trace/scenes.h"
#include "tests/support/golden.h"

namespace sunfleck::test {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.45, 0.25, 0.86));
constexpr int kRays = 1024;

class Truth {
 public:
  Truth(const Forest& forest, const Vec3& to_sun, double half_angle_rad, std::size_t sampled)
      : index_(forest) {
    Illumination light;
    light.to_sun = to_sun;
    light.sun_half_angle_rad = half_angle_rad;
    const ProbeScene scene(forest, true, {});
    const std::size_t step = std::max<std::size_t>(1, index_.element_count() / sampled);
    for (std::size_t e = 0; e < index_.element_count(); e += step) {
      RandomStream random(5, e, RandomPurpose::kTestScene);
      const auto sun = trace::sun_on_surface(scene.rays(), trace::SurfaceSampler(scene.receivers(), e), light,
                                             kRays, trace::SunPoints::kSpread, random);
      const ForestIndex::Place place = index_.place(e);
      elements_.push_back(e);
      beam_.push_back(beam_on_faces(forest, place.instance, place.local, to_sun).both());
      seen_.push_back(sun.seen);
      const Prototype& p = forest.prototypes[forest.instances[place.instance].prototype.value];
      is_shoot_.push_back(p.foliage[place.local].shape == ElementShape::kShoot);
    }
  }

  // As SunExposure::relative_error, against the truth, whose noise is taken off; the error of the mean;
  // squares found over claimed.
  struct Found {
    double error = 0, bias = 0, bias_error = 0, ratio = 0;
  };
  Found compare(const SunExposure& sun) const {
    Found f;
    double light = 0, squares = 0, claimed = 0, noise = 0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const std::size_t e = elements_[i];
      const double d = beam_[i] * (sun.sunlit_fraction[e] - seen_[i]), b2 = beam_[i] * beam_[i];
      squares += d * d;
      f.bias += d;
      light += beam_[i] * seen_[i];
      claimed += b2 * sun.standard_error[e] * sun.standard_error[e];
      // Spread points on leaves: a tenth of random ones; in shoots as random ones, whose needles are met by
      // lot.
      noise += b2 * seen_[i] * (1 - seen_[i]) / kRays * (is_shoot_[i] ? 0.95 : 0.1);
    }
    const auto n = static_cast<double>(elements_.size());
    f.ratio = squares / (claimed + noise);
    f.error = std::sqrt(std::max(0.0, squares - noise) / n) / (light / n);
    f.bias_error = std::sqrt(squares) / light;
    f.bias /= light;
    return f;
  }

 private:
  ForestIndex index_;
  std::vector<std::size_t> elements_;
  std::vector<double> beam_, seen_;
  std::vector<bool> is_shoot_;
};

Forest grown(const char* species, double dbh_cm) {
  ForestSpec spec;
  InventoryTree tree;
  tree.species = species;
  tree.dbh_cm = dbh_cm;
  spec.inventory.push_back(tree);
  return grow_forest(spec, SpeciesLibrary::load(source_dir() / "configs/species"), {});
}

Forest stand() {
  Forest forest = generated_crown({.leaves = 3000, .radius_m = 0.6, .crown_lai = 4, .seed = 3});
  for (int i = 1; i < 4; ++i) {
    forest.instances.push_back(forest.instances[0]);
    forest.instances.back().position_m += Vec3(0.9 * (i % 2), 0.8 * (i / 2), 0);
    forest.instances.back().yaw_rad = static_cast<float>(i);
  }
  forest.period = Period{{-0.5, -0.5}, {2, 1.7}};
  return forest;
}

Forest sloped(Forest forest) {
  forest.terrain.slope_rad = 0.4;
  forest.terrain.aspect_rad = 2;
  for (Instance& i : forest.instances)
    i.position_m.z += forest.terrain.height_at(i.position_m.x, i.position_m.y);
  return forest;
}

struct Scene {
  const char* name;
  Forest forest;
  Vec3 to_sun = kSun;
  double least_ratio = 0.7, most_ratio = 1.25;
};

std::vector<Scene> scenes() {
  return {{"sphere", generated_crown({.leaves = 8000})},
          {"clumped", generated_crown({.kind = CrownKind::kClumped, .leaves = 8000})},
          {"periodic stand", stand()},
          {"periodic stand, low sun", stand(), glm::normalize(Vec3(0.6, 0.7, 0.12)), 0.3,
           1.8},  // a few lit leaves decide
          {"periodic stand on a slope", sloped(stand())},
          {"crown on a slope", sloped(generated_crown({.leaves = 8000}))},
          // Twigs close above their leaves: two rims in one pixel, which the error takes as one.
          {"beech", grown("Fagus sylvatica", 8), kSun, 0.7, 1.35},
          // Needle clouds are estimated on the safe side.
          {"spruce", grown("Picea abies", 8), kSun, 0.4}};
}

TEST(SunRasterAgainstRays, RightOnAverageWithinItsErrorWhichShrinksWithThePixel) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const Truth truth(scene.forest, scene.to_sun, 0, 1500);
    const ForestIndex index(scene.forest);
    const double side =
        std::sqrt(forest_leaf_area_m2(scene.forest) / static_cast<double>(index.element_count()));
    double error_before = 1e3;
    for (const double part : {0.4, 0.2, 0.1}) {
      const SunExposure sun = raster_sun(scene.forest, index, scene.to_sun, 0, {.pixel_m = part * side}, {});
      const Truth::Found f = truth.compare(sun);
      std::printf("%-26s pixel %.3f sides: error %.2f %%, bias %+.2f %%, found/claimed %.2f\n", scene.name,
                  part, 100 * f.error, 100 * f.bias, f.ratio);
      EXPECT_LT(std::abs(f.bias), 4 * f.bias_error + 0.002);
      EXPECT_GT(f.ratio, scene.least_ratio);
      EXPECT_LT(f.ratio, scene.most_ratio);
      // 2^1.5 = 2.8 per halving, less where the truth's own noise shows.
      EXPECT_LT(f.error, error_before / 1.8);
      error_before = f.error;
    }
  }
}

TEST(SunRasterAgainstRays, TheTargetIsMet) {
  const Forest forest = generated_crown({.kind = CrownKind::kClumped, .leaves = 8000});
  const Truth truth(forest, kSun, 0, 1500);
  for (const double target : {0.2, 0.05}) {
    const SunExposure sun = raster_sun(forest, ForestIndex(forest), kSun, 0, {.target_error = target}, {});
    const Truth::Found f = truth.compare(sun);
    EXPECT_NEAR(sun.relative_error / target, 0.93, 0.15);
    EXPECT_NEAR(f.error / target, 0.95, 0.25);
  }
}

// Penumbras as wide as leaves: pictures from points of the disc against rays to random points of it.
TEST(SunRasterAgainstRays, TheSunsDisc) {
  const Forest forest = generated_crown({.leaves = 8000});
  const double half_angle = 0.05;
  const Truth truth(forest, kSun, half_angle, 1500);
  const SunExposure sun =
      raster_sun(forest, ForestIndex(forest), kSun, half_angle, {.pixel_m = 0.008, .sun_directions = 16}, {});
  const Truth::Found f = truth.compare(sun);
  EXPECT_LT(std::abs(f.bias), 4 * f.bias_error + 0.002);
  EXPECT_LT(f.error, 0.06);
  EXPECT_LT(f.ratio, 1.3);
}

}  // namespace
}  // namespace sunfleck::test
