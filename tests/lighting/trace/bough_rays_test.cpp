// Shoots as boughs in closed form, by lot (RayScene) and as expected values (BoughScene).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lighting/shade/shoot_bough.h"
#include "lighting/trace/bough_scene.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "tests/lighting/trace/scenes.h"
#include "tests/sim/plant/refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

FoliageTemplate needles_of(const std::string& file) {
  return load_species(test::source_dir() / "configs/species" / (file + ".toml")).foliage;
}

FoliageElement shoot_of(const FoliageTemplate& f, const Vec3& centre, const Vec3& axis) {
  return test::shoot(centre, 0.5 * f.shoot_length_m * glm::normalize(axis), f.shoot_radius_m,
                     f.shoot_area_m2());
}

Forest one_shoot(const FoliageTemplate& f) { return test::forest_of({shoot_of(f, Vec3(0), {1, 0.3, 0.2})}); }

// Shoots that hide each other, in trees turned, scaled and moved.
Forest few_trees(const FoliageTemplate& f) {
  RandomStream random(3, 0, RandomPurpose::kTestScene);
  std::vector<FoliageElement> shoots;
  for (int i = 0; i < 60; ++i)
    shoots.push_back(
        shoot_of(f, Vec3(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(0, 0.4)),
                 Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0.3)));
  Forest forest = test::forest_of(shoots);
  forest.instances = {{{0, 0, 0}, {}, 0.5f, 1.0f, {}},
                      {{0.4, 0.1, 0}, {}, -2.0f, 0.7f, {}},
                      {{-0.3, 0.5, 0}, {}, 3.0f, 1.4f, {}}};
  return forest;
}

RayScene::Options by_lot(const FoliageTemplate& f) {
  return {.ground = false, .shoots = ShootForm::kBough, .needles = {{"m0", f}}};
}

struct Line {
  Vec3 origin_m, direction;
};
Line any_line(RandomStream& random, const Vec3& through, double radius_m) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  const Vec3 d(r * std::cos(turn), r * std::sin(turn), z);
  const Basis basis = basis_around(d);
  const double rho = radius_m * std::sqrt(random.uniform()), at = random.uniform(0, 2 * kPi);
  return {
      through + rho * (std::cos(at) * basis.tangent + std::sin(at) * basis.bitangent) - 4.0 * radius_m * d,
      d};
}

double closed_form(const Forest& forest, const FoliageTemplate& f, const Line& line) {
  double through = 1;
  for (const Instance& at : forest.instances)
    for (const FoliageElement& e : forest.prototypes[0].foliage) {
      const ShootBough b = shoot_bough(e, f);
      const Vec3 o = b.into_bough(tree_from_world(at, line.origin_m) - b.origin_m);
      through *= std::exp(-bough_depth(
          b.volume, o,
          bough_direction(b.volume, b.into_bough(tree_direction_from_world(at, line.direction)))));
    }
  return through;
}

// 40 ways through one shoot, 4,000 rays along each that differ by a nanometre (every ray has its own lot):
// the share that meets a needle is 1 - exp(-depth). Standard error 0.008, largest of 40: four of them.
TEST(BoughRays, ByLotMeetWhatTheDepthSays) {
  const FoliageTemplate f = needles_of("picea_abies");
  const Forest forest = one_shoot(f);
  const RayScene rays(forest, by_lot(f));
  RandomStream random(4, 0, RandomPurpose::kTestScene);
  double worst = 0;
  for (int way = 0; way < 40; ++way) {
    const Line line = any_line(random, Vec3(0), 0.02);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 origin = line.origin_m + 1e-9 * i * Vec3(1, 0, 0);
      const bool shaded = rays.occluded(origin, line.direction);
      met += shaded;
      if (i < 100) {
        const RayHit hit = rays.closest_hit(origin, line.direction);
        EXPECT_EQ(hit.kind == HitKind::kFoliage, shaded);
        if (shaded) {
          EXPECT_EQ(hit.needle, RayHit::kSomeNeedle);
          EXPECT_LE(glm::dot(hit.normal, line.direction), 1e-9);
          EXPECT_NEAR(glm::length(hit.normal), 1, 1e-9);
        }
      }
    }
    worst = std::max(worst, std::abs(met / 4000.0 - (1 - closed_form(forest, f, line))));
  }
  EXPECT_LT(worst, 4 * 0.008);
}

// The needles of the conifers one by one, and their boughs: mean opacity over all ways. Boughs know that
// needles lean and stand closer near the axis, but not that fir's are combed flat and larch's stand in tufts.
TEST(BoughRays, OpacityAgainstNeedles) {
  struct Known {
    const char* file;
    double ratio;
  };
  for (const Known& k : {Known{"picea_abies", 0.94}, Known{"abies_alba", 1.06},
                         Known{"pinus_sylvestris", 0.94}, Known{"larix_decidua", 1.18}}) {
    const FoliageTemplate f = needles_of(k.file);
    const Forest forest = one_shoot(f);
    const BoughScene boughs(forest, std::vector<NeedleKind>{{"m0", f}});
    RayScene::Options each = by_lot(f);
    each.shoots = ShootForm::kNeedles;
    const RayScene needles(forest, each);
    RandomStream random(5, 0, RandomPurpose::kTestScene);
    double met = 0, expected = 0;
    for (int i = 0; i < 60000; ++i) {
      const Line line = any_line(random, Vec3(0), 0.06);
      met += needles.occluded(line.origin_m, line.direction);
      expected += 1 - boughs.transmittance(line.origin_m, line.direction);
    }
    EXPECT_NEAR(expected / met, k.ratio, 0.03) << k.file;  // three standard errors
  }
}

// 600 ways through interlocking, turned and scaled trees; single precision, and no more than 1.5 in 1000 is
// left unasked.
TEST(BoughRays, ExpectedValuesAreTheClosedForm) {
  const FoliageTemplate f = needles_of("picea_abies");
  const Forest forest = few_trees(f);
  const BoughScene boughs(forest, std::vector<NeedleKind>{{"m0", f}});
  const BoughScene::Lit lit(boughs, {{0, -5, 0}, false, {}}, {0, 0, 1});
  RandomStream random(6, 0, RandomPurpose::kTestScene);
  double shaded = 0;
  for (int i = 0; i < 600; ++i) {
    const Line line = any_line(random, {0, 0.1, 0.2}, 0.5);
    const double known = closed_form(forest, f, line);
    EXPECT_NEAR(boughs.transmittance(line.origin_m, line.direction), known, 4e-3) << i;
    const BoughScene::Seen seen = boughs.seen(line.origin_m, line.direction, lit);
    EXPECT_NEAR(static_cast<double>(seen.through), known, 6e-3) << i;
    EXPECT_GE(seen.reflected, 0.0f);
    EXPECT_LE(seen.reflected, 1.0f - seen.through + 1e-5f);
    shaded += 1 - known;
  }
  EXPECT_GT(shaded, 60);
}

TEST(BoughRays, SameForAnyNumberOfThreads) {
  const FoliageTemplate f = needles_of("picea_abies");
  const Forest forest = few_trees(f);
  const auto run = [&] {
    const BoughScene boughs(forest, std::vector<NeedleKind>{{"m0", f}});
    const BoughScene::Lit lit(boughs, {{0, -5, 0}, false, {}}, glm::normalize(Vec3(1, -1, 1)), 2);
    std::vector<float> found(4000);
    for_each_chunk(found.size(), 32, {}, "", [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        RandomStream random(7, i, RandomPurpose::kTestScene);
        const Line line = any_line(random, {0, 0.1, 0.2}, 0.5);
        found[i] = boughs.seen(line.origin_m, line.direction, lit).reflected;
      }
    });
    return found;
  };
  std::vector<float> one, three;
  with_threads(1, [&] { one = run(); });
  with_threads(3, [&] { three = run(); });
  EXPECT_EQ(one, three);
}

TEST(BoughRays, BadInputIsRefused) {
  const FoliageTemplate f = needles_of("picea_abies");
  Forest forest = one_shoot(f);
  test::expect_refused([&] { BoughScene(forest, {}); }, ErrorKind::kInvalidInput, "needles", "'m0'",
                       "species");
  forest.instances[0].yaw_rad = std::numeric_limits<float>::quiet_NaN();
  test::expect_refused(
      [&] {
        BoughScene(forest, std::vector<NeedleKind>{{"m0", f}});
      },
      ErrorKind::kInvalidInput, "instances[0]", "not a finite", "finite");
  forest.instances[0] = {};
  forest.instances[0].position_m.x = std::numeric_limits<double>::infinity();
  test::expect_refused(
      [&] {
        BoughScene(forest, std::vector<NeedleKind>{{"m0", f}});
      },
      ErrorKind::kInvalidInput, "instances[0]", "not a finite", "finite");
}

}  // namespace
}  // namespace sunfleck
