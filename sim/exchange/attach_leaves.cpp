#include "sim/exchange/attach_leaves.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"
#include "sim/base/random.h"
#include "sim/exchange/qsm.h"
#include "sim/plant/leaf_angle_sampling.h"
#include "sim/plant/template_element.h"

namespace sunfleck {
namespace {

void require_possible(const Prototype& tree, const LeavesOnWood& leaves) {
  if (tree.wood.empty())
    throw_invalid(tree.name, "has no wood to put leaves on", "import its cylinders first");
  if (!(leaves.leaf_area_m2 > 0.0 && leaves.leaf_area_m2 <= 1e6))
    throw_invalid("leaf area", "is not possible", "give square metres above 0");
  if (leaves.elements < 1 || leaves.elements > 50'000'000)
    throw_invalid("elements", std::to_string(leaves.elements) + " leaves are not possible",
                  "give 1 to 50000000");
}

// Length of twigs up to and with each segment; segments that are no twigs add nothing.
std::vector<double> twig_length_to_here_m(const std::vector<WoodSegment>& wood) {
  std::vector<bool> carries(wood.size(), false);
  const std::vector<int> parents = wood_parents(wood);
  for (const int parent : parents)
    if (parent >= 0) carries[static_cast<std::size_t>(parent)] = true;
  std::vector<double> sums;
  double sum_m = 0;
  for (std::size_t i = 0; i < wood.size(); ++i) {
    const bool is_twig = !carries[i] || std::max(wood[i].radius_from_m, wood[i].radius_to_m) < kTwigRadius_m;
    if (is_twig) sum_m += glm::distance(Vec3(wood[i].from_m), Vec3(wood[i].to_m));
    sums.push_back(sum_m);
  }
  return sums;
}

// A point beside the segment, `away_m` from its bark.
Vec3 beside(const WoodSegment& s, double share, double away_m, double turn_rad) {
  const Vec3 from_m(s.from_m), to_m(s.to_m);
  const Basis basis = basis_around(glm::normalize(to_m - from_m));
  const double radius_m = s.radius_from_m + share * (s.radius_to_m - s.radius_from_m);
  const Vec3 outwards = std::cos(turn_rad) * basis.tangent + std::sin(turn_rad) * basis.bitangent;
  return from_m + share * (to_m - from_m) + (radius_m + away_m) * outwards;
}

FoliageElement place_leaf(const Prototype& tree, const Species& species, const std::vector<double>& sums,
                          double at_m, double area_m2, RandomStream& random) {
  const auto found = std::upper_bound(sums.begin(), sums.end(), at_m);
  const auto segment = static_cast<std::size_t>(std::min(found, sums.end() - 1) - sums.begin());
  const double before_m = segment > 0 ? sums[segment - 1] : 0.0;
  const double share = std::clamp((at_m - before_m) / (sums[segment] - before_m), 0.0, 1.0);
  const FoliageTemplate& foliage = species.foliage;
  const double away_m = foliage.kind == FoliageKind::kLeaf ? 0.5 * std::sqrt(area_m2) : 0.0;
  const Vec3 centre_m = beside(tree.wood[segment], share, away_m, random.uniform(0.0, 2.0 * kPi));
  return template_element(foliage, area_m2, centre_m, sample_leaf_normal(foliage.angles, random),
                          random.uniform(0.0, 2.0 * kPi));
}

}  // namespace

void attach_leaves(Prototype& tree, const Species& species, const LeavesOnWood& leaves) {
  require_possible(tree, leaves);
  const std::vector<double> sums = twig_length_to_here_m(tree.wood);
  const auto count = static_cast<std::size_t>(leaves.elements);
  const double each_m2 = static_cast<float>(leaves.leaf_area_m2 / leaves.elements);
  double left_m2 = leaves.leaf_area_m2;
  tree.foliage.reserve(tree.foliage.size() + count);
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(leaves.seed, i, RandomPurpose::kCrownFill);
    const double at_m = (static_cast<double>(i) + random.uniform()) / leaves.elements * sums.back();
    tree.foliage.push_back(place_leaf(tree, species, sums, at_m, i + 1 < count ? each_m2 : left_m2, random));
    left_m2 -= each_m2;
  }
}

}  // namespace sunfleck
