// Pruned foliage keeps area, levels nest, far views stay the same; and the choice between representations.
#include "lighting/shade/prune.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>

#include "lighting/shade/choose_detail.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

const Prototype& crown() {
  static const Forest forest = generated_crown({CrownKind::kSphere, 40000, 1, 4, 3});
  return forest.prototypes[0];
}

double area_of(std::span<const FoliageElement> foliage, int material) {
  double area = 0;
  for (const FoliageElement& e : foliage)
    if (e.material == material) area += static_cast<double>(e.area_m2);
  return area;
}

TEST(Prune, KeepsAreaAndNests) {
  std::vector<FoliageElement> foliage = crown().foliage;
  for (std::size_t i = 0; i < foliage.size(); ++i) foliage[i].material = i % 100 == 0 ? 1 : 0;
  foliage[7].material = 2;  // the only leaf of its kind
  std::vector<std::uint32_t> finer(foliage.size());
  for (std::uint32_t i = 0; i < finer.size(); ++i) finer[i] = i;
  for (const double keep : {1.0, 0.25, 1.0 / 16, 1.0 / 64, 1e-6}) {
    const PrunedFoliage pruned = prune_leaves(foliage, keep, 5);
    for (int m = 0; m < 3; ++m)
      EXPECT_NEAR(area_of(pruned.foliage, m) / area_of(foliage, m), 1, 1e-5) << keep;
    EXPECT_TRUE(std::includes(finer.begin(), finer.end(), pruned.original.begin(), pruned.original.end()));
    finer = pruned.original;
    const double expected = keep * 40000;  // binomial, 5 standard deviations and one leaf per material
    EXPECT_NEAR(static_cast<double>(pruned.foliage.size()), expected, 5 * std::sqrt(expected) + 3);
    for (std::size_t i = 0; i < pruned.foliage.size(); ++i) {
      const FoliageElement &e = pruned.foliage[i], &from = foliage[pruned.original[i]];
      EXPECT_EQ(e.centre_m, from.centre_m);
      EXPECT_NEAR(element_geometric_area(e), static_cast<double>(e.area_m2),
                  1e-4 * static_cast<double>(e.area_m2));
      EXPECT_NEAR(glm::dot(element_normal(e), element_normal(from)), 1, 1e-6);
    }
  }
  const PrunedFoliage all = prune_leaves(foliage, 1, 5);
  EXPECT_EQ(all.foliage.size(), foliage.size());
  EXPECT_EQ(all.foliage[3].half_u_m, foliage[3].half_u_m);
}

TEST(Prune, DependsOnTheSeedAlone) {
  const auto a = prune_leaves(crown().foliage, 0.1, 1), b = prune_leaves(crown().foliage, 0.1, 1);
  const auto c = prune_leaves(crown().foliage, 0.1, 2);
  EXPECT_EQ(a.original, b.original);
  EXPECT_NE(a.original, c.original);
  // A leaf's fate does not depend on the others: the first half alone keeps the same leaves.
  const auto half = prune_leaves(std::span(crown().foliage).first(20000), 0.1, 1);
  ASSERT_LT(half.original.size(), a.original.size());
  EXPECT_TRUE(std::equal(half.original.begin(), half.original.end(), a.original.begin()));
}

// Shoots: opacity across one (needle area per volume times diameter) and total outline stay.
TEST(Prune, ShootsKeepTheirOpacity) {
  std::vector<FoliageElement> shoots(1000);
  for (FoliageElement& e : shoots) {
    e.shape = ElementShape::kShoot;
    e.half_u_m = {0.05f, 0, 0};
    e.half_v_m = {0, 0.01f, 0};
    e.area_m2 = 0.002f;
  }
  const PrunedFoliage pruned = prune_leaves(shoots, 0.2, 3);
  double outline = 0;
  for (const FoliageElement& e : pruned.foliage) {
    const double length = static_cast<double>(glm::length(e.half_u_m)),
                 radius = static_cast<double>(glm::length(e.half_v_m));
    outline += 4 * length * radius;
    EXPECT_NEAR(static_cast<double>(e.area_m2) / (length * radius * radius) * radius, 0.002 / (0.05 * 0.01),
                1e-4);
  }
  EXPECT_NEAR(outline, 1000 * 4 * 0.05 * 0.01, 1e-5);
}

Forest forest_of(Prototype prototype) {
  Forest forest = generated_crown({CrownKind::kSphere, 10, 1, 4, 3});
  forest.prototypes[0] = std::move(prototype);
  return forest;
}

// Share of parallel rays through the crown's disc that meet leaves.
double cover(const Prototype& prototype, const Vec3& to_viewer) {
  const Forest forest = forest_of(prototype);
  const RayScene scene(forest, {.ground = false});
  const Basis basis = basis_around(to_viewer);
  RandomStream random(1, 0, RandomPurpose::kTestScene);
  int hits = 0;
  const int side = 200;
  for (int i = 0; i < side * side; ++i) {
    const double a = (i % side + random.uniform()) / side * 2 - 1,
                 b = (i / side + random.uniform()) / side * 2 - 1;
    hits += scene.occluded(Vec3(0, 0, 1.5) + a * basis.tangent + b * basis.bitangent + 5.0 * to_viewer,
                           -to_viewer);
  }
  return hits / static_cast<double>(side * side);
}

// The sheet's coverage errors are -.6, 1.5, 1.5 % at f = 1/4, 1/16, 1/64 on 100,000 leaves. Here 40,000: 625
// leaves at 1/64 are .17 wide on a ball of radius 1, whose edge they blur; and their number scatters: 4 %.
TEST(Prune, FarViewsKeepTheirCover) {
  const Vec3 v = glm::normalize(Vec3(1, 2, 0.5));
  const double whole = cover(crown(), v);
  for (const auto& [keep, bound] :
       std::map<double, double>{{0.25, 0.015}, {1.0 / 16, 0.025}, {1.0 / 64, 0.05}}) {
    const double pruned = cover(prune_prototype(crown(), keep, 5), v);
    std::cout << "f = " << keep << ": cover " << pruned << " of " << whole << "\n";
    EXPECT_NEAR(pruned / whole, 1, bound);
  }
}

TEST(Prune, RuleAndLevels) {
  EXPECT_EQ(prune_share(0.31, 1), 1);
  EXPECT_NEAR(prune_share(0.155, 1), 0.25, 1e-12);
  EXPECT_EQ(prune_share(1e-9, 1), 1.0 / 64);
  EXPECT_EQ(prune_share(5, 1), 1);
  EXPECT_EQ(choose_prune_level(0.31, 1, 0), 0);
  EXPECT_EQ(choose_prune_level(0.154, 1, 0), 1);  // just below the threshold: the coarser one by lot
  EXPECT_EQ(choose_prune_level(0.154, 1, 0.99), 0);
  EXPECT_EQ(choose_prune_level(0.154 / 1.4, 1, 0.99), 1);
  EXPECT_EQ(choose_prune_level(1e-6, 1, 0.99), 3);
  for (double leaf = 1e-3; leaf < 1; leaf *= 1.01)  // never fewer leaves than the rule allows
    for (const double u : {0.0, 0.5, 0.99})
      EXPECT_GE(kPruneLevels[static_cast<std::size_t>(choose_prune_level(leaf, 1, u))] * (1 + 1e-9),
                prune_share(leaf, 1));
}

TEST(Prune, RefusesNonsense) {
  EXPECT_THROW(prune_leaves(crown().foliage, 0, 1), Error);
  EXPECT_THROW(prune_leaves(crown().foliage, 1.5, 1), Error);
  EXPECT_THROW(prune_leaves(crown().foliage, std::nan(""), 1), Error);
  EXPECT_TRUE(prune_leaves({}, 0.5, 1).foliage.empty());
}

DetailTable example() {
  return DetailTable({{Detail::kExplicit, 0.01, 0, 400},
                      {Detail::kExplicit, 0.1, 0, 600},
                      {Detail::kPruned4, 0.03, 0.02, 300},
                      {Detail::kPruned4, 0.1, 0.01, 300},
                      {Detail::kPruned64, 0.1, 0.02, 150},
                      {Detail::kBillboards, 0.1, 0.001, 900}});
}

TEST(ChooseDetail, CheapestWithinTheTolerance) {
  const DetailTable table = example();
  EXPECT_EQ(table.choose(0.1, 0.03, 0), Detail::kPruned64);
  EXPECT_EQ(table.choose(0.1, 0.015, 0), Detail::kPruned4);
  EXPECT_EQ(table.choose(0.1, 0.005, 0), Detail::kExplicit);  // billboards would do but cost more
  EXPECT_EQ(table.choose(0.02, 1, 0), Detail::kExplicit);     // nothing else measured that near
  EXPECT_EQ(table.choose(10, 0.03, 0.9), Detail::kPruned64);
  EXPECT_EQ(table.choose(0.1, 0.03, 0, LightUse::kLightMap), Detail::kExplicit);
  EXPECT_NEAR(table.at(Detail::kPruned4, std::sqrt(0.03 * 0.1)).rms_error, 0.015, 1e-12);
  EXPECT_EQ(DetailTable({}).choose(1, 1, 0), Detail::kExplicit);
}

// Over instances the share that has changed grows from 0 to 1 with the footprint, in order: an instance that
// changed stays changed. The error of what is chosen is within the tolerance at every footprint.
TEST(ChooseDetail, BlendsWithoutPopping) {
  const DetailTable table = example();
  std::vector<Detail> before(1000, Detail::kExplicit);
  double last = 0;
  for (double footprint = 0.09; footprint < 0.15; footprint *= 1.01) {
    double changed = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Detail now = table.choose(footprint, 0.025, detail_choice(1, i));
      EXPECT_FALSE(before[i] == Detail::kPruned64 && now != Detail::kPruned64);
      EXPECT_LE(table.at(now, footprint).rms_error, 0.025);
      before[i] = now;
      changed += (now == Detail::kPruned64) / 1000.0;
    }
    EXPECT_LT(changed - last, 0.08);  // 1 % of footprint is 2.5 to 3.5 % of the instances, and their noise
    last = changed;
  }
  EXPECT_NEAR(last, 1, 1e-9);
}

TEST(ChooseDetail, RefusesNonsense) {
  EXPECT_THROW(DetailTable({{Detail::kBough, 0, 0, 1}}), Error);
  EXPECT_THROW(DetailTable({{Detail::kBough, 1, -1, 1}}), Error);
  EXPECT_THROW(DetailTable({{Detail::kBough, 1, 0, std::nan("")}}), Error);
  EXPECT_THROW(DetailTable({{Detail::kBough, 1, 0, 1}, {Detail::kBough, 1, 0, 2}}), Error);
}

}  // namespace
}  // namespace sunfleck
