#include "sim/plant/grow_foliage.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr std::uint64_t kFoliageSeed = 0x666F6C69;  // apart from the seeds of derivation steps

FoliageElement element_at(const lsystem::TurtleState& turtle, const FoliageTemplate& foliage,
                          double area_m2) {
  const double scale = std::sqrt(area_m2 / template_area_m2(foliage));
  if (foliage.kind == FoliageKind::kLeaf)
    return rhombic_leaf(turtle, scale * foliage.leaf_length_m, scale * foliage.leaf_width_m);
  return shoot_element(turtle, scale * foliage.shoot_length_m, scale * foliage.shoot_radius_m, area_m2);
}

}  // namespace

FoliageElement rhombic_leaf(const lsystem::TurtleState& turtle, double length_m, double width_m) {
  const Vec3 along = 0.5 * length_m * turtle.heading, across = 0.5 * width_m * turtle.left;
  FoliageElement leaf;
  leaf.centre_m = Vec3f(turtle.position_m + along);
  leaf.half_u_m = Vec3f(0.5 * (along - across));  // u x v = along x across / 2, along H x L = U
  leaf.half_v_m = Vec3f(0.5 * (along + across));
  leaf.area_m2 = static_cast<float>(0.5 * length_m * width_m);
  leaf.shape = ElementShape::kParallelogram;
  return leaf;
}

FoliageElement shoot_element(const lsystem::TurtleState& turtle, double length_m, double radius_m,
                             double area_m2) {
  FoliageElement shoot;
  shoot.half_u_m = Vec3f(0.5 * length_m * turtle.heading);
  shoot.half_v_m = Vec3f(radius_m * turtle.left);
  shoot.centre_m = Vec3f(turtle.position_m) + shoot.half_u_m;
  shoot.area_m2 = static_cast<float>(area_m2);
  shoot.shape = ElementShape::kShoot;
  return shoot;
}

double template_area_m2(const FoliageTemplate& foliage) {
  return foliage.kind == FoliageKind::kLeaf ? 0.5 * foliage.leaf_length_m * foliage.leaf_width_m
                                            : foliage.shoot_area_m2();
}

std::vector<std::size_t> choose_organs(std::size_t organs, const FoliageTemplate& foliage,
                                       double leaf_area_m2, double detail, std::uint64_t seed) {
  SUNFLECK_EXPECTS(organs > 0 && leaf_area_m2 > 0);
  const auto available = static_cast<double>(organs);
  const double share = detail * std::min(available, leaf_area_m2 / template_area_m2(foliage)) / available;
  const std::uint64_t foliage_seed = mix_seed(seed, kFoliageSeed);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < organs; ++i)
    if (share >= 1 || RandomStream(foliage_seed, i, RandomPurpose::kLsystem).uniform() < share)
      chosen.push_back(i);
  if (chosen.empty()) chosen.push_back(0);
  return chosen;
}

std::vector<FoliageElement> foliage_of(const std::vector<lsystem::Organ>& organs,
                                       std::span<const std::size_t> chosen, const FoliageTemplate& foliage,
                                       double leaf_area_m2) {
  SUNFLECK_EXPECTS(!chosen.empty() && leaf_area_m2 > 0);
  const double area_m2 = leaf_area_m2 / static_cast<double>(chosen.size());
  std::vector<FoliageElement> elements;
  elements.reserve(chosen.size());
  for (const std::size_t i : chosen) elements.push_back(element_at(organs[i].turtle, foliage, area_m2));
  return elements;
}

}  // namespace sunfleck
