// The forms of the world grid's innermost step agree, for leaves with like and with unlike faces, for every
// set of directions; and neither makes nor loses light.
#include <gtest/gtest.h>

#include "lighting/transport/world_scatter.h"
#include "tests/lighting/transport/world_stand.h"

namespace sunfleck::test {
namespace {

using namespace transport;

std::vector<WorldKernels> kernels_of(const DirectionSet& set) {
  Forest forest = stand({.side = 2, .leaves = 400});
  forest.prototypes[0].wood.push_back({{0, 0, 0}, {0.5, 0, 3}, 0.15f, 0.1f, 0});
  forest.prototypes[1].foliage.push_back(shoot({0, 0, 2}, {0.1, 0.05, 0.02}, 0.03, 0.02));
  const auto prototypes = world_prototypes(forest, 0.5, {});
  const LeafOptics alike{.reflectance_front = 0.4,
                         .reflectance_back = 0.4,
                         .transmittance_front = 0.3,
                         .transmittance_back = 0.3};
  const LeafOptics unlike{.reflectance_front = 0.6,
                          .reflectance_back = 0.1,
                          .transmittance_front = 0.2,
                          .transmittance_back = 0.3};
  std::vector<WorldKernels> all;
  for (const LeafOptics& leaf : {alike, unlike}) {
    const OpticsTable optics(
        forest, {.bands = {"VIS"}, .soil_albedo = {0.2}, .overrides = {{"*", "VIS", {leaf, 0.3}}}});
    all.push_back(world_kernels(prototypes, set, optics, 0, glm::normalize(Vec3(0.3, 0.2, 0.7)), {}));
  }
  EXPECT_TRUE(all[0].kinds[0].faces_alike);
  EXPECT_FALSE(all[1].kinds[0].faces_alike);
  return all;
}

TEST(ScatterCell, FormsAgree) {
  RandomStream random(7, 0, RandomPurpose::kTestScene);
  for (const int directions : {8, 14, 26}) {
    const DirectionSet set = cubic_directions(directions);
    for (const WorldKernels& kernels : kernels_of(set)) {
      for (int cell = 0; cell < 50; ++cell) {
        std::vector<WorldEntry> entries;
        for (std::uint32_t kind = 0; kind < kernels.kinds.size(); ++kind)
          if (random.uniform() < 0.5) entries.push_back({kind, static_cast<float>(random.uniform(0, 2))});
        BothLanes radiance{};
        for (std::size_t j = 0; j < set.half(); ++j) {
          radiance[j] = static_cast<float>(random.uniform(0, 100));
          radiance[kLanes + j] = static_cast<float>(random.uniform(0, 100));
        }
        const auto sun = static_cast<float>(random.uniform(0, 900));
        alignas(64) BothLanes plain{}, best{};
        scatter_cell_plain(entries, kernels.kinds.data(), radiance, sun, plain);
        scatter_cell_best()(entries, kernels.kinds.data(), radiance, sun, best);
        float largest = 0.0f;
        for (const float s : plain) largest = std::max(largest, s);
        for (std::size_t j = 0; j < kBothLanes; ++j)
          ASSERT_NEAR(plain[j], best[j], 4e-6f * largest);  // 26 products each rounded to 6e-8, in any order
      }
    }
  }
}

TEST(ScatterCell, GivesBackWhatIsNotAbsorbed) {
  // The source over all directions and the absorbed power add up to what is taken; for a set that is exact
  // for |cos| only to some percent.
  const DirectionSet set = cubic_directions(26);
  for (const WorldKernels& kernels : kernels_of(set)) {
    for (std::uint32_t kind = 0; kind < 6; ++kind) {
      if (kernels.kinds[kind].irradiance[0] == 0.0f) continue;  // no such content
      BothLanes radiance{};
      for (std::size_t j = 0; j < 13; ++j) radiance[j] = radiance[kLanes + j] = 1.0f;
      alignas(64) BothLanes source{};
      const std::vector<WorldEntry> one{{kind, 1.0f}};
      scatter_cell_plain(one, kernels.kinds.data(), radiance, 0.0f, source);
      double sent = 0.0, absorbed = 0.0, taken = 0.0;
      for (std::size_t j = 0; j < 13; ++j) {
        sent += set.solid_angle_sr[j] * (static_cast<double>(source[j]) + source[kLanes + j]);
        absorbed +=
            static_cast<double>(kernels.kinds[kind].absorbed[j]) + kernels.kinds[kind].absorbed[kLanes + j];
        taken += static_cast<double>(kernels.kinds[kind].irradiance[j]) +
                 kernels.kinds[kind].irradiance[kLanes + j];
      }
      EXPECT_NEAR((sent + absorbed) / taken, 1.0, 0.02) << kind;
    }
  }
}

}  // namespace
}  // namespace sunfleck::test
