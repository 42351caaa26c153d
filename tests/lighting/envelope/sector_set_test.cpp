// Direction sets: how exactly they integrate over the sphere, and what sky and ground they see.
#include "lighting/envelope/sector_set.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sunfleck::envelope {
namespace {

double integral(const SectorSet& set, int px, int py, int pz) {
  double sum = 0.0;
  for (std::size_t j = 0; j < set.count(); ++j) {
    const Vec3& w = set.to_source[j];
    sum += set.solid_angle_sr[j] * std::pow(w.x, px) * std::pow(w.y, py) * std::pow(w.z, pz);
  }
  return sum;
}

TEST(CubicSectors, IntegratePolynomialsOfTheirDegree) {
  // Even moments over the sphere: 4 pi (px-1)!! (py-1)!! (pz-1)!! / (px + py + pz + 1)!!; rounding only.
  for (const int count : kSectorCounts) {
    const SectorSet set = cubic_sectors(count);
    EXPECT_NEAR(integral(set, 0, 0, 0), 4 * kPi, 1e-13) << count;
    EXPECT_NEAR(integral(set, 2, 0, 0), 4 * kPi / 3, 1e-13) << count;
    if (count >= 14) {
      EXPECT_NEAR(integral(set, 4, 0, 0), 4 * kPi / 5, 1e-13) << count;
      EXPECT_NEAR(integral(set, 2, 2, 0), 4 * kPi / 15, 1e-13) << count;
    }
    if (count >= 26) {
      EXPECT_NEAR(integral(set, 6, 0, 0), 4 * kPi / 7, 1e-13) << count;
      EXPECT_NEAR(integral(set, 2, 2, 2), 4 * kPi / 105, 1e-13) << count;
    }
    if (count == 50) {
      EXPECT_NEAR(integral(set, 10, 0, 0), 4 * kPi / 11, 1e-13);
      EXPECT_NEAR(integral(set, 4, 4, 2), 4 * kPi * 9 / 10395, 1e-13);
    }
  }
}

TEST(CubicSectors, ComeInOppositePairs) {
  for (const int count : kSectorCounts) {
    const SectorSet set = cubic_sectors(count);
    ASSERT_EQ(set.count(), static_cast<std::size_t>(count));
    for (std::size_t j = 0; j < set.count(); ++j) {
      EXPECT_NEAR(glm::length(set.to_source[j]), 1.0, 1e-15);
      EXPECT_EQ(set.to_source[set.opposite(j)], -set.to_source[j]);
    }
  }
}

TEST(LayeredSectors, GiveTheFluxThroughALayerExactlyAndNeverRunLevel) {
  const Vec3 pole = glm::normalize(Vec3(0.2, -0.1, 1));
  for (const int count : kSectorCounts) {
    const SectorSet set = layered_sectors(count, pole);
    double flux = 0.0, sum = 0.0;
    for (std::size_t j = 0; j < set.count(); ++j) {
      const double cosine = glm::dot(set.to_source[j], pole);
      EXPECT_GT(std::abs(cosine), 0.08) << count;
      flux += set.solid_angle_sr[j] * std::max(0.0, cosine);
      sum += set.solid_angle_sr[j];
    }
    EXPECT_NEAR(flux, kPi, 1e-12) << count;
    EXPECT_NEAR(sum, 4 * kPi, 1e-12) << count;
  }
}

TEST(SectorSky, KeepsTheSky) {
  for (const int count : kSectorCounts)
    for (const bool layered : {false, true}) {
      const SectorSet set = layered ? layered_sectors(count, {0, 0, 1}) : cubic_sectors(count);
      const SectorSky sky = sector_sky(set, SkyModel::kUniform, {0, 0, 1});
      for (std::size_t j = 0; j < set.count(); ++j) {
        // Uniform: radiance 1 / pi on the part that is sky.
        EXPECT_NEAR(sky.sky_radiance[j], (1 - sky.ground_share[j]) / kPi, 1e-12) << count;
        EXPECT_NEAR(sky.ground_share[j] + sky.ground_share[set.opposite(j)], 1.0, 1e-12) << count;
      }
      EXPECT_NEAR(sky.open_ground_irradiance, 1.0, 1e-3);  // midpoints of 64 cosines
    }
}

}  // namespace
}  // namespace sunfleck::envelope
