// Boughs that no parameter was chosen on, against rays through every needle, with the sheet's gates; finite
// boughs; the ray caster itself against the file's.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "lighting/shade/bough_light.h"
#include "lighting/shade/bough_table.h"
#include "lighting/shade/needle_rays.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

Vec3 direction(double zenith_rad, double azimuth_rad) {
  const double s = std::sin(zenith_rad);
  return {s * std::cos(azimuth_rad), s * std::sin(azimuth_rad), std::cos(zenith_rad)};
}

// Even over the sphere, 20 degrees and more off the axis: nearer to it a strip has no end.
Vec3 any_direction(RandomStream& random) {
  const double z = random.uniform(-0.94, 0.94);
  return direction(std::acos(z), random.uniform(0, 2 * kPi));
}

Bough with_whorls(Bough bough, int cones) {
  bough.cones = cones;
  return bough;
}

const Bough kPaper{{12, 4.25, 0.05, kPi / 8}, 0.9, 0, 4};

struct HeldOut {
  const char* name;
  Bough bough;
};

// 40 random pairs on each; other phases, apertures and needle counts than any the model was looked at with.
TEST(BoughRays, HeldOutBoughsWithinTheGates) {
  for (const HeldOut& held : {HeldOut{"paper, new phases", kPaper},
                              {"30 deg", {{16, 3, 0.04, kPi / 6}, 0.6, 0, 4}},
                              {"50 deg", {{10, 2, 0.03, radians_from_degrees(50)}, 0.3, 0, 4}}}) {
    const Bough& bough = held.bough;
    const double radius = bough.cone.length * std::sin(bough.cone.aperture_rad);
    const double reach = 2 * (2 * radius * 2.8 + bough.cone.length) * 2;
    const NeedleRays needles(with_whorls(bough, static_cast<int>(reach / bough.spacing) + 40), 77);
    const BoughVolume volume = bough_volume(bough);
    RandomStream random(11, 0, RandomPurpose::kTestScene);
    double opacity = 0, light = 0, mean = 0;
    const int pairs = 40;
    for (int i = 0; i < pairs; ++i) {
      const Vec3 v = any_direction(random), l = any_direction(random);
      const TracedBough truth = trace_bough_strip(needles, radius, v, l, 6000, 1000 + i);
      const BoughLight value = bough_strip(volume, radius, v, l);
      EXPECT_NEAR(value.opacity, truth.opacity, 0.04 + 3 * truth.opacity_se) << held.name;
      opacity += std::abs(value.opacity - truth.opacity) / pairs;
      light += std::abs(value.reflected - truth.reflected) / pairs;
      mean += truth.reflected / pairs;
    }
    std::cout << held.name << ": opacity " << opacity << ", light " << 100 * light / mean << " %\n";
    EXPECT_LT(light / mean, 0.09) << held.name;
  }
}

// The limit that bough.h states: flat whorls, one needle length cos(70 deg) = 1.03 spacings high, seen side
// on show the gaps between them. If this passes the gate some day, the header is to be mended.
TEST(BoughRays, FlatWhorlsThatStandApartAreTheLimit) {
  const Bough bough{{14, 1.5, 0.04, radians_from_degrees(70)}, 0.5, 0, 4};
  const double radius = bough.cone.length * std::sin(bough.cone.aperture_rad);
  const NeedleRays needles(with_whorls(bough, 100), 77);
  const Vec3 v = direction(radians_from_degrees(80), 0);
  const TracedBough truth = trace_bough_strip(needles, radius, v, v, 20000, 3);
  const double opacity = bough_strip(bough_volume(bough), radius, v, v).opacity;
  std::cout << "flat whorls: opacity " << opacity << ", traced " << truth.opacity << "\n";
  EXPECT_GT(std::abs(opacity - truth.opacity), 0.04);
  EXPECT_LT(std::abs(opacity - truth.opacity), 0.13);
}

// Our needles and those of the file (another program) agree: 6 views, 4 standard errors of both together.
TEST(BoughRays, RaysAgreeWithTheFile) {
  const nlohmann::json file = test::golden("pine.json");
  const auto& cases = file.at("level3_bough").at("cases");
  for (std::size_t i = 0; i < 30; i += 5) {
    const auto& c = cases[i];
    const Bough bough{{c["N"], c["l"], c["r"], c["alpha_rad"]}, c["dh"], 400, 4};
    const NeedleRays needles(bough, 3);
    const double degree = kPi / 180;
    const TracedBough traced = trace_bough_strip(
        needles, bough.cone.length * std::sin(bough.cone.aperture_rad),
        direction(c["thV_deg"].get<double>() * degree, 0),
        direction(c["thL_deg"].get<double>() * degree, c["dphi_deg"].get<double>() * degree), 20000, 5);
    const double opacity_se = std::hypot(traced.opacity_se, c["opacity_se"].get<double>());
    const double light_se = std::hypot(traced.reflected_se, c["I_se"].get<double>());
    EXPECT_NEAR(traced.opacity, c["opacity"].get<double>(), 4 * opacity_se) << c;
    EXPECT_NEAR(traced.reflected, c["I"].get<double>(), 4 * light_se) << c;
  }
}

// A finite bough seen whole: mean over a disc of rays. Ends included, the gates hold.
TEST(BoughRays, FiniteBoughSeenWhole) {
  const Bough bough = with_whorls(kPaper, 10);
  const NeedleRays needles(bough, 21);
  const BoughVolume volume = bough_volume(bough);
  RandomStream random(12, 0, RandomPurpose::kTestScene);
  for (const double zenith : {0.02, 0.4, 1.2, 2.0, 3.1}) {
    const Vec3 v = direction(zenith, 0.3), l = direction(0.9, 1.5);
    const Basis basis = basis_around(v);
    const BoughDirection ray = bough_direction(volume, -v), sun = bough_direction(volume, l);
    double hits = 0, light = 0, model_hits = 0, model_light = 0;
    const int rays = 20000;
    for (int i = 0; i < rays; ++i) {
      const Vec3 through =
          Vec3(0, 0, 6) + random.uniform(-6, 6) * basis.tangent + random.uniform(-6, 6) * basis.bitangent;
      const Vec3 origin = through + 30.0 * v;
      const auto hit = needles.closest_hit(origin, -v, 0);
      if (hit) {
        hits += 1.0 / rays;
        const double cosine = glm::dot(hit->normal, l);
        const Vec3 point = origin - hit->distance * v + 1e-7 * hit->normal;
        if (cosine > 0 && !needles.occluded(point, l, 0)) light += cosine / rays;
      }
      const BoughLight value = bough_light(volume, origin, ray, sun);
      model_hits += value.opacity / rays;
      model_light += value.reflected / rays;
    }
    std::cout << "zenith " << zenith << ": cover " << hits << " model " << model_hits << ", light " << light
              << " model " << model_light << "\n";
    // Noise of 20000 rays: .003 of cover .2 (1.5 %); needles near the ends are regular: 10 % in all.
    EXPECT_NEAR(model_hits, hits, 0.1 * hits + 0.004);
    EXPECT_NEAR(model_light, light, 0.15 * light + 0.004);
  }
}

// A table baked from the closed form gives it back between its entries; baked from rays, it holds the truth.
TEST(BoughRays, TablesHoldWhatTheyWereBakedFrom) {
  const BoughVolume volume = bough_volume(kPaper);
  const double radius = 4.25 * std::sin(kPi / 8);
  const BoughTable table(16,
                         [&](const Vec3& v, const Vec3& l) { return bough_strip(volume, radius, v, l, 8); });
  EXPECT_LT(table.memory_bytes(), 20000u);
  RandomStream random(13, 0, RandomPurpose::kTestScene);
  double off = 0, mean = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 v = any_direction(random), l = any_direction(random);
    const BoughLight exact = bough_strip(volume, radius, v, l, 8), looked_up = table.at(v, l);
    EXPECT_NEAR(looked_up.opacity, exact.opacity, 0.01);
    off += std::abs(looked_up.reflected - exact.reflected);
    mean += exact.reflected;
  }
  std::cout << "table of 16 rows: " << 100 * off / mean << " % of the mean light\n";
  EXPECT_LT(off / mean, 0.04);
}

TEST(BoughRays, SameBytesForAnyThreadsAndErrorsThatShrink) {
  const NeedleRays needles(with_whorls(kPaper, 120), 9);
  const Vec3 v = direction(1.2, 0), l = direction(0.9, 1);
  TracedBough one, two;
  with_threads(1, [&] { one = trace_bough_strip(needles, 1.6, v, l, 2000, 4); });
  with_threads(3, [&] { two = trace_bough_strip(needles, 1.6, v, l, 2000, 4); });
  EXPECT_EQ(one.reflected, two.reflected);
  EXPECT_EQ(one.opacity_se, two.opacity_se);
  const TracedBough many = trace_bough_strip(needles, 1.6, v, l, 32000, 4);
  EXPECT_NEAR(many.opacity_se / one.opacity_se, 0.25, 0.13);  // 20 blocks: 16 % noise of each error
}

TEST(BoughRays, RefusesWhatItCannotSee) {
  EXPECT_THROW(NeedleRays(kPaper, 1), Error);  // endless
  const NeedleRays few(with_whorls(kPaper, 5), 1);
  EXPECT_THROW(trace_bough_strip(few, 1.6, direction(0.3, 0), direction(1, 1), 100, 1), Error);
  EXPECT_THROW(trace_bough_strip(few, 1.6, Vec3(0, 0, 1), direction(1, 1), 100, 1), Error);
  EXPECT_THROW(BoughTable(1, {}), Error);
}

}  // namespace
}  // namespace sunfleck
