// Wood that crosses: found where it does, not at forks; what is taken away leaves none.
#include "sim/plant/wood_contacts.h"

#include <gtest/gtest.h>

#include "sim/base/random.h"

namespace sunfleck {
namespace {

WoodSegment rod(const Vec3f& from, const Vec3f& to, float radius) { return {from, to, radius, radius, 0}; }

// A stem with two boughs; a twig on each.
std::vector<WoodSegment> forked(float twig_offset_m) {
  return {rod({0, 0, 0}, {0, 0, 2}, 0.05f), rod({0, 0, 2}, {1, 0, 2}, 0.02f),
          rod({0, 0, 2}, {0, 1, 2}, 0.02f), rod({1, 0, 2}, {1, 1, 2}, 0.01f),
          rod({0, 1, 2}, {2, 1, 2 + twig_offset_m}, 0.01f)};
}
const std::vector<std::int32_t> kForkedParents{-1, 0, 0, 1, 2};

// The twigs meet at (1, 1, 2): the second passes there at half of its offset, radii 0.01 + 0.01.
TEST(WoodContacts, AreFoundToTheMillimetre) {
  EXPECT_EQ(wood_contacts(forked(0.0f), kForkedParents, 0).size(), 1u);
  EXPECT_EQ(wood_contacts(forked(0.039f), kForkedParents, 0).size(), 1u);
  EXPECT_EQ(wood_contacts(forked(0.042f), kForkedParents, 0).size(), 0u);
  const auto one = wood_contacts(forked(0.0f), kForkedParents, 0);
  EXPECT_EQ(one[0].first, 3u);
  EXPECT_EQ(one[0].second, 4u);
  EXPECT_NEAR(one[0].overlap_m, 0.02, 1e-6);
  EXPECT_EQ(wood_contacts(forked(0.0f), kForkedParents, 2.1).size(), 0u);  // tolerance above the overlap
}

TEST(WoodContacts, ForksAreNone) {
  auto wood = forked(1.0f);
  EXPECT_TRUE(wood_contacts(wood, kForkedParents, 0).empty());
}

TEST(WoodContacts, TheThinnerGoesWithWhatGrowsOnIt) {
  auto wood = forked(0.0f);
  wood[3].radius_from_m = wood[3].radius_to_m = 0.008f;
  wood.push_back(rod({1, 1, 2}, {1, 1, 3}, 0.004f));
  auto parents = kForkedParents;
  parents.push_back(3);
  const auto away = crossing_branches(wood, parents, 0);
  EXPECT_EQ(away, (std::vector<bool>{false, false, false, true, false, true}));
}

// Random rods in a metre cube, all on one root: plain counting of all pairs says the same as the cells do.
TEST(WoodContacts, EqualThePlainCount) {
  RandomStream random(4, 0, RandomPurpose::kTestScene);
  const auto point = [&] { return Vec3f(random.uniform(1, 2), random.uniform(1, 2), random.uniform(1, 2)); };
  std::vector<WoodSegment> wood{rod({0, 0, 0}, {0, 0, 0.01f}, 0.001f)};
  std::vector<std::int32_t> parents{-1};
  for (int i = 0; i < 200; ++i) {
    wood.push_back(rod({0, 0, 0.01f}, point(), 0.0f));  // to where the rod begins; has no thickness
    parents.push_back(0);
    wood.push_back(rod(wood.back().to_m, point(), 0.01f));
    parents.push_back(static_cast<std::int32_t>(wood.size()) - 2);
  }
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < wood.size(); ++i)
    for (std::size_t j = i + 1; j < wood.size(); ++j) {
      const std::vector<WoodSegment> two{wood[i], wood[j]};
      const bool kin = parents[j] == static_cast<std::int32_t>(i) || parents[i] == parents[j];
      if (!kin && wood[i].radius_from_m + wood[j].radius_from_m > 0.0015f)
        pairs += wood_contacts(two, std::vector<std::int32_t>{-1, -1}, 0).size();
    }
  std::size_t found = 0;
  for (const WoodContact& c : wood_contacts(wood, parents, 0))
    found += wood[c.first].radius_from_m + wood[c.second].radius_from_m > 0.0015f ? 1 : 0;
  EXPECT_GT(found, 50u);
  EXPECT_EQ(found, pairs);
}

TEST(WoodContacts, ParentsAreFoundByTheirEnds) { EXPECT_EQ(wood_parents(forked(0.3f)), kForkedParents); }

}  // namespace
}  // namespace sunfleck
