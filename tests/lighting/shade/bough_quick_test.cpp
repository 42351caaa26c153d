// One ray through one bough in single precision against its exact twin, and the bough of a shoot.
#include "lighting/shade/bough_quick.h"

#include <gtest/gtest.h>

#include "lighting/shade/shoot_bough.h"
#include "sim/base/random.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// Apertures from 3 to 88 degrees, few and many whorls, rays from outside and from inside, bounded and not.
TEST(BoughQuick, IsItsExactTwin) {
  RandomStream random(1, 0, RandomPurpose::kTestScene);
  double worst = 0, opaque = 0;
  for (int i = 0; i < 40000; ++i) {
    Bough bough{{12, 1, 0.012, random.uniform(0.05, 1.53)}, 0.2, 1 + static_cast<int>(random.below(40)), 3};
    const BoughVolume v = bough_volume(bough);
    const Vec3 d = any_direction(random);
    const double high = v.highest + v.outer_radius * v.cos_aperture / v.sin_aperture;
    const Vec3 inside(random.uniform(-1, 1) * v.outer_radius, random.uniform(-1, 1) * v.outer_radius,
                      random.uniform(v.lowest, high));
    const double back = i % 3 == 0 ? 0.0 : random.uniform(0, 30);
    const Vec3 origin = inside - back * d;
    const BoughDirection ray = bough_direction(v, d);
    const double exact = std::exp(-bough_depth(v, origin, ray));
    const QuickCrossing c = quick_crossing(quick_bough(v), Vec3f(origin), Vec3f(d), 0.0f, 1e30f);
    worst = std::max(worst, std::abs(exact - std::exp(-static_cast<double>(c.depth))));
    opaque += 1 - exact;
    if (!(c.depth > 0)) continue;
    // Cut in two, the parts have the depth of the whole.
    const float cut = 0.4f * c.enter + 0.6f * c.leave;
    const float parts = quick_crossing(quick_bough(v), Vec3f(origin), Vec3f(d), 0.0f, cut).depth +
                        quick_crossing(quick_bough(v), Vec3f(origin), Vec3f(d), cut, 1e30f).depth;
    EXPECT_NEAR(std::exp(-parts), std::exp(-c.depth), 2e-3) << i;
  }
  EXPECT_LT(worst, 2e-3);
  EXPECT_GT(opaque, 4000);  // of 40,000: the rays do meet needles
}

TEST(BoughQuick, KeepsTheSpotsWhereItIsAskedNothing) {
  const QuickBough b = quick_bough(bough_volume({{12, 1, 0.012, 0.4}, 0.2, 5, 3}));
  for (const Vec3f& d : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(1, 0, 0)})
    for (const Vec3f& o : {Vec3f(0, 0, 0), Vec3f(0, 0, -5), Vec3f(5, 5, 5), Vec3f(1e6f, 0, 0)}) {
      const QuickCrossing c = quick_crossing(b, o, d, 0.0f, 1e30f);
      EXPECT_TRUE(std::isfinite(c.depth) && c.depth >= 0);
    }
}

// Mean depth of lines that meet a ball of radius R evenly: half the one-sided needle area over pi R^2
// (needles whose projections are counted in full), and the share by which the bough is a needle's radius
// wider than where its needles end (bough.h). 100,000 lines, three standard errors of 0.6 %.
TEST(ShootBough, KeepsTheNeedleArea) {
  for (const char* file : {"picea_abies", "abies_alba", "pinus_sylvestris", "larix_decidua"}) {
    const FoliageTemplate f =
        load_species(test::source_dir() / "configs/species" / (std::string(file) + ".toml")).foliage;
    FoliageElement e;
    e.shape = ElementShape::kShoot;
    e.centre_m = {0, 0, 0};
    e.half_u_m = Vec3f(0, 0, static_cast<float>(0.5 * f.shoot_length_m));
    e.half_v_m = Vec3f(static_cast<float>(f.shoot_radius_m), 0, 0);
    e.area_m2 = static_cast<float>(f.shoot_area_m2());
    const ShootBough b = shoot_bough(e, f);
    const double radius = 1.1 * std::hypot(0.5 * f.shoot_length_m, f.shoot_radius_m);
    RandomStream random(2, 0, RandomPurpose::kTestScene);
    double sum = 0;
    constexpr int kLines = 100000;
    for (int i = 0; i < kLines; ++i) {
      const Vec3 d = any_direction(random);
      const Basis basis = basis_around(d);
      const double rho = radius * std::sqrt(random.uniform()), turn = random.uniform(0, 2 * kPi);
      const Vec3 o =
          rho * (std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent) - 3.0 * radius * d;
      sum += quick_crossing(quick_bough(b.volume), Vec3f(b.into_bough(o - b.origin_m)),
                            Vec3f(b.into_bough(d)), 0.0f, 1e30f)
                 .depth;
    }
    const double wider = b.volume.outer_radius / (b.volume.outer_radius - 0.5 * f.needle_width_m);
    const double known = wider * 0.5 * f.shoot_area_m2() / (kPi * radius * radius);
    EXPECT_NEAR(sum / kLines, known, 0.02 * known) << file;
    // It fills the shoot's cylinder.
    EXPECT_NEAR(b.volume.outer_radius, f.shoot_radius_m, 0.25 * f.shoot_radius_m) << file;
  }
}

}  // namespace
}  // namespace sunfleck
