// Leaves on scanned wood: the stated area, on twigs only, in proportion to their length, the same every time.
#include "sim/exchange/attach_leaves.h"

#include <cmath>

#include "tests/sim/plant/crown_fixture.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

// A bole without twigs, a thick end of 1 m and a thin twig of 3 m.
Prototype bare_tree() {
  Prototype tree;
  tree.name = "bare";
  tree.materials = {"Fagus fixture"};
  tree.wood = {{{0, 0, 0}, {0, 0, 10}, 0.2f, 0.1f, 0},
               {{0, 0, 10}, {0, 0, 11}, 0.1f, 0.08f, 0},
               {{0, 0, 10}, {3, 0, 10}, 0.005f, 0.005f, 0}};
  return tree;
}

TEST(AttachLeaves, TheStatedAreaOnTwigsInProportionToLength) {
  for (const Species& species : {test::broadleaf(), test::conifer()}) {
    Prototype tree = bare_tree();
    attach_leaves(tree, species, {12.5, 4000, 3});
    ASSERT_EQ(tree.foliage.size(), 4000u);
    EXPECT_NEAR(leaf_area_m2(tree), 12.5, 12.5 * 1e-5);  // sum of floats
    validate(tree, "tree");
    std::size_t on_twig = 0;
    for (const FoliageElement& e : tree.foliage) {
      const bool by_twig = e.centre_m.x > 0.15f;
      if (!by_twig) {
        EXPECT_GT(e.centre_m.z, 9.8f);  // none on the bole
      }
      on_twig += by_twig;
    }
    // 3 of 4 m of twigs, less the 0.15 m beside the stem; stratified, so to a few leaves.
    EXPECT_NEAR(static_cast<double>(on_twig), 4000 * (3 - 0.15) / 4, 40);
  }
}

TEST(AttachLeaves, SameSeedSameLeaves) {
  Prototype a = bare_tree(), b = bare_tree(), c = bare_tree();
  attach_leaves(a, test::broadleaf(), {5, 100, 3});
  attach_leaves(b, test::broadleaf(), {5, 100, 3});
  attach_leaves(c, test::broadleaf(), {5, 100, 4});
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(a.foliage[i].centre_m, b.foliage[i].centre_m);
  EXPECT_NE(a.foliage[0].centre_m, c.foliage[0].centre_m);
}

TEST(AttachLeaves, RefusesWhatIsImpossible) {
  Prototype none, tree = bare_tree();
  none.name = "none";
  using test::expect_refused;
  expect_refused([&] { attach_leaves(none, test::broadleaf(), {}); }, ErrorKind::kInvalidInput, "none",
                 "no wood", "cylinders");
  expect_refused(
      [&] {
        attach_leaves(tree, test::broadleaf(), {-1, 10, 1});
      },
      ErrorKind::kInvalidInput, "leaf area", "not possible", "above 0");
  expect_refused(
      [&] {
        attach_leaves(tree, test::broadleaf(), {std::nan(""), 10, 1});
      },
      ErrorKind::kInvalidInput, "leaf area", "not possible", "above 0");
  expect_refused(
      [&] {
        attach_leaves(tree, test::broadleaf(), {5, 0, 1});
      },
      ErrorKind::kInvalidInput, "elements", "not possible", "1 to");
}

}  // namespace
}  // namespace sunfleck
