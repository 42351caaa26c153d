// The forms of the grid's innermost step agree, for flat leaves and shoots, few and many, with and without
// direct light; and what a white leaf gives back is what it takes.
#include <gtest/gtest.h>

#include "lighting/transport/leaf_kernel.h"
#include "sim/base/random.h"

namespace sunfleck::transport {
namespace {

struct Content {
  DirectionLanes lanes;
  std::vector<LeafPart> parts;
  std::vector<ShootPart> shoots;
  std::vector<LeafBand> bands;
  std::vector<FacePair> direct, last, total;
  CellLight cell;

  LeafOrder order(bool with_direct) {
    return {.parts = parts.data(),
            .shoots = shoots.data(),
            .bands = bands.data(),
            .direct = with_direct ? direct.data() : nullptr,
            .beam_w_m2 = 700,
            .scale = 1.5f,
            .last = last.data(),
            .total = total.data()};
  }
};

Content random_content(std::size_t leaves, std::uint64_t seed) {
  RandomStream random(seed, 0, RandomPurpose::kTestScene);
  const auto value = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
  const DirectionSet set = cubic_directions(26);
  Content c;
  c.lanes = direction_lanes(set, std::vector<double>(set.half(), 1.3));
  c.bands = {{0.5f, 0.4f, 0.3f, 0.35f, 0.775f}, {0.1f, 0.1f, 0.05f, 0.05f, 0.15f}};
  for (std::uint32_t i = 0; i < leaves; ++i) {
    LeafPart part;
    const Vec3 normal(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    part.normal = Vec3f(glm::normalize(normal));
    part.cover = value(0, 1.2);
    part.element = i;
    part.optics = i % 2;
    if (i % 5 == 4) {
      ShootPart shoot{.escape = value(0.2, 1)};
      for (std::size_t j = 0; j < set.half(); ++j) shoot.cover[j] = value(0.01, 0.8);
      c.shoots.push_back(shoot);
      part.shoot = static_cast<std::uint32_t>(c.shoots.size());
    }
    c.parts.push_back(part);
    c.direct.push_back({value(0, 1), value(0, 1)});
    c.last.push_back({value(0, 300), value(0, 300)});
    c.total.push_back({value(0, 900), value(0, 900)});
  }
  for (std::size_t j = 0; j < set.half(); ++j) {
    c.cell.near[j] = value(0, 200);
    c.cell.far[j] = value(0, 200);
    c.cell.source_near[j] = value(0, 5);
    c.cell.source_far[j] = value(0, 5);
    c.cell.depth[j] = value(0, 0.5);
  }
  return c;
}

// Sums of some ten products, each rounded to 6e-8, in any order.
void expect_near(float a, float b) { EXPECT_NEAR(a, b, 3e-6f * std::max(1.0f, std::abs(a))); }

TEST(ScatterLeaves, FormsAgree) {
  for (const std::size_t leaves : {0, 1, 2, 7, 40}) {
    for (const bool with_direct : {false, true}) {
      Content plain = random_content(leaves, leaves + 1), best = plain;
      const auto end = static_cast<std::uint32_t>(leaves);
      const double power = scatter_leaves_plain(plain.order(with_direct), plain.lanes, 0, end, plain.cell);
      EXPECT_NEAR(scatter_leaves_best()(best.order(with_direct), best.lanes, 0, end, best.cell), power,
                  3e-6 * power);
      for (std::size_t j = 0; j < kLanes; ++j) {
        expect_near(plain.cell.source_near[j], best.cell.source_near[j]);
        expect_near(plain.cell.source_far[j], best.cell.source_far[j]);
        expect_near(plain.cell.depth[j], best.cell.depth[j]);
      }
      for (std::size_t p = 0; p < leaves; ++p) {
        expect_near(plain.last[p].front, best.last[p].front);
        expect_near(plain.last[p].back, best.last[p].back);
        expect_near(plain.total[p].front, best.total[p].front);
        expect_near(plain.total[p].back, best.total[p].back);
      }
    }
  }
}

TEST(EmitLeaves, FormsAgree) {
  for (const std::size_t leaves : {0, 1, 2, 7, 40}) {
    Content plain = random_content(leaves, leaves + 1), best = plain;
    const auto end = static_cast<std::uint32_t>(leaves);
    emit_leaves_plain(plain.order(false), plain.lanes, plain.last.data(), 0, end, plain.cell);
    emit_leaves_best()(best.order(false), best.lanes, best.last.data(), 0, end, best.cell);
    for (std::size_t j = 0; j < kLanes; ++j) {
      expect_near(plain.cell.source_near[j], best.cell.source_near[j]);
      expect_near(plain.cell.source_far[j], best.cell.source_far[j]);
      expect_near(plain.cell.depth[j], best.cell.depth[j]);
    }
  }
}

TEST(ScatterLeaves, AWhiteLeafInEvenLightKeepsItEven) {
  Content c = random_content(1, 3);
  c.bands[0] = {0.7f, 0.7f, 0.3f, 0.3f, 1.0f};
  const auto even = static_cast<float>(10 / kPi);
  c.cell = {};
  for (std::size_t j = 0; j < 13; ++j) c.cell.near[j] = c.cell.far[j] = even;
  c.last[0] = {10, 10};
  LeafOrder order = c.order(false);
  order.scale = 1;
  scatter_leaves_best()(order, c.lanes, 0, 1, c.cell);
  EXPECT_NEAR(c.last[0].front, 10.0f, 1e-4f);
  EXPECT_NEAR(c.last[0].back, 10.0f, 1e-4f);
  for (std::size_t j = 0; j < 13; ++j) {
    EXPECT_NEAR(c.cell.source_near[j], even * c.cell.depth[j], 1e-5f);
    EXPECT_NEAR(c.cell.source_far[j], even * c.cell.depth[j], 1e-5f);
  }
}

}  // namespace
}  // namespace sunfleck::transport
