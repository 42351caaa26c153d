#include "lighting/shade/mask_leaves.h"

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostLeaves = 4096;

MaskLeaves::Leaf outline(const FoliageElement& e) {
  MaskLeaves::Leaf leaf{glm::length(Vec3(e.half_u_m)), glm::length(Vec3(e.half_v_m)), e.shape, 1};
  if (e.shape == ElementShape::kShoot) {  // seen side on: length x diameter, random needles inside
    const double rectangle = 4 * leaf.half_u_m * leaf.half_v_m;
    leaf.cover = rectangle > 0 ? -std::expm1(-0.5 * static_cast<double>(e.area_m2) / rectangle) : 0;
  }
  return leaf;
}

double outline_area(const MaskLeaves::Leaf& leaf) {
  const double box = leaf.half_u_m * leaf.half_v_m;
  switch (leaf.shape) {
    case ElementShape::kDisc:
      return kPi * box;
    case ElementShape::kTriangle:
      return 0.5 * box;
    case ElementShape::kParallelogram:
    case ElementShape::kShoot:
      break;
  }
  return 4 * box;
}

}  // namespace

double MaskLeaves::side_m() const { return std::sqrt(mean_area_m2); }

MaskLeaves mask_leaves(const Prototype& crown, const char* where) {
  MaskLeaves leaves;
  const std::size_t count = crown.foliage.size(), picked = std::min(count, kMostLeaves);
  Box box;
  for (const FoliageElement& e : crown.foliage) box.include(Vec3(e.centre_m));
  for (std::size_t i = 0; i < picked; ++i) {
    const MaskLeaves::Leaf leaf = outline(crown.foliage[i * count / picked]);
    leaves.leaf.push_back(leaf);
    leaves.mean_area_m2 += outline_area(leaf) / static_cast<double>(picked);
    leaves.mean_cover_m2 += outline_area(leaf) * leaf.cover / static_cast<double>(picked);
  }
  if (!(leaves.mean_cover_m2 > 0) || !std::isfinite(leaves.mean_cover_m2))
    throw_invalid(where, "no leaves with an area to make a shadow mask of", "a crown with foliage");
  const double least = leaves.side_m();  // a flat or single-leaf crown still has a volume
  const Vec3 size = glm::max(box.size(), Vec3(least));
  leaves.per_m3 = static_cast<double>(count) / (kPi / 6 * size.x * size.y * size.z);
  return leaves;
}

PlacedLeaf place_leaf(const MaskLeaves& leaves, const Vec3& centre, RandomStream& random) {
  const MaskLeaves::Leaf& leaf = leaves.leaf[random.below(static_cast<std::uint32_t>(leaves.leaf.size()))];
  const double z = random.uniform(-1, 1), azimuth = random.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  const Vec3 normal(r * std::cos(azimuth), r * std::sin(azimuth), z);
  const Basis basis = basis_around(normal);
  const double turn = random.uniform(0, 2 * kPi);
  const Vec3 u = std::cos(turn) * basis.tangent + std::sin(turn) * basis.bitangent;
  return {centre, leaf.half_u_m * u, leaf.half_v_m * glm::cross(normal, u), normal, leaf.shape, leaf.cover};
}

bool leaf_covers(ElementShape shape, double a, double b) {
  switch (shape) {
    case ElementShape::kDisc:
      return a * a + b * b <= 1;
    case ElementShape::kTriangle: {  // corners centre - (u+v)/3, + u, + v
      const double s = a + 1.0 / 3, t = b + 1.0 / 3;
      return s >= 0 && t >= 0 && s + t <= 1;
    }
    case ElementShape::kParallelogram:
    case ElementShape::kShoot:
      break;
  }
  return std::abs(a) <= 1 && std::abs(b) <= 1;
}

}  // namespace sunfleck
