// The forms of the gather agree, for flat leaves and shoots between any cells; and in even light every face
// gets pi times its radiance.
#include <gtest/gtest.h>

#include "lighting/transport/gather_kernel.h"
#include "sim/base/random.h"

namespace sunfleck::transport {
namespace {

struct Around {
  DirectionSet set = cubic_directions(26);
  DirectionLanes lanes = direction_lanes(set, std::vector<double>(set.half(), 1.2));
  std::vector<CellRadiance> radiance = std::vector<CellRadiance>(20), other = radiance;
  ShootPart shoot;
  LeafPart part;
  Corners corners;

  explicit Around(std::uint64_t seed) {
    RandomStream random(seed, 0, RandomPurpose::kTestScene);
    const auto value = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
    for (std::vector<CellRadiance>* cells : {&radiance, &other})
      for (CellRadiance& cell : *cells)
        for (std::size_t j = 0; j < set.half(); ++j) {
          cell.near[j] = value(0, 200);
          cell.far[j] = value(0, 200);
        }
    part.normal = Vec3f(glm::normalize(Vec3(value(-1, 1), value(-1, 1), value(-1, 1))));
    part.cover = value(0, 1.2);
    shoot.escape = value(0.2, 1);
    for (std::size_t j = 0; j < set.half(); ++j) shoot.cover[j] = value(0.01, 0.8);
    for (std::size_t k = 0; k < 8; ++k) {
      corners.cell[k] = random.below(20);
      corners.weight[k] = 0.125f;
    }
    corners.own_cell = corners.cell[3];
    corners.own_weight = value(0.1, 1);
  }
  PartInLight in_light(bool is_shoot, const FacePair& given) const {
    return {.part = part,
            .shoot = is_shoot ? &shoot : nullptr,
            .corners = corners,
            .radiance = {radiance.data(), other.data()},
            .given = {given, {20, 70}}};
  }
};

TEST(GatherPart, FormsAgree) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Around a(seed);
    for (const bool is_shoot : {false, true}) {
      const PartInLight part = a.in_light(is_shoot, {100, 30});
      FacePair plain[2], best[2];
      gather_part_plain(part, a.lanes, plain);
      gather_part_best()(part, a.lanes, best);
      for (int i = 0; i < 2; ++i) {
        // Sums of 26 x 8 products, each rounded to 6e-8, in any order.
        EXPECT_NEAR(plain[i].front, best[i].front, 1e-5f * plain[i].front) << seed << is_shoot;
        EXPECT_NEAR(plain[i].back, best[i].back, 1e-5f * plain[i].back) << seed << is_shoot;
      }
    }
  }
}

TEST(GatherPart, TakesOneKindOfLightAsItTakesTwo) {
  const Around a(3);
  PartInLight part = a.in_light(false, {100, 30});
  FacePair both[2], one[2] = {{-1, -1}, {-1, -1}};
  gather_part_best()(part, a.lanes, both);
  part.radiance[1] = nullptr;
  gather_part_best()(part, a.lanes, one);
  EXPECT_EQ(one[0].front, both[0].front);
  EXPECT_EQ(one[0].back, both[0].back);
  EXPECT_EQ(one[1].front, -1.0f);
}

TEST(GatherPart, EvenLightIsEvenOnEveryFace) {
  Around a(7);
  for (CellRadiance& cell : a.radiance)
    for (std::size_t j = 0; j < a.set.half(); ++j) cell.near[j] = cell.far[j] = 2.0f;
  const auto sent = static_cast<float>(2.0 * kPi);  // of the same radiance
  FacePair light[2];
  gather_part_best()(a.in_light(false, {sent, sent}), a.lanes, light);
  EXPECT_NEAR(light[0].front, sent, 1e-5f * sent);
  EXPECT_NEAR(light[0].back, sent, 1e-5f * sent);
}

}  // namespace
}  // namespace sunfleck::transport
