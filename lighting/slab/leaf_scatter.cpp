// Means over leaf normals; see leaf_scatter.h.
#include "lighting/slab/leaf_scatter.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

constexpr std::size_t kMostLeaves = 2048;

template <class Visit>
void for_picked_leaves(const Prototype& prototype, const Visit& visit) {
  const std::size_t step = (prototype.foliage.size() + kMostLeaves - 1) / kMostLeaves;
  for (std::size_t i = 0; i < prototype.foliage.size(); i += step) visit(prototype.foliage[i]);
}

// Normals everywhere alike.
LeafScatter random_leaves(double cosine) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double both = 2.0 / (3.0 * kPi) * (std::sin(angle) + (0.5 * kPi - angle) * std::cos(angle));
  const double towards = -cosine / 3.0;
  return {0.5, towards, 0.5 * (both + towards), 0.5 * (both - towards)};
}

}  // namespace

ScatterShares LeafScatter::shares(double q) const {
  if (!(projection > 0.0)) return {};
  const double scale = 1.0 / (kPi * projection);
  return {0.25 * scale * (projection + q * towards), 0.25 * scale * (projection - q * towards),
          0.5 * scale * ((1.0 + q) * lit + (1.0 - q) * unlit)};
}

LeafScatter leaf_scatter(const Prototype& prototype, const Vec3& look, const Vec3& to_light) {
  const LeafScatter random = random_leaves(glm::dot(look, to_light));
  LeafScatter sum{0.0, 0.0, 0.0, 0.0};
  double area = 0.0;
  const auto add = [&](double weight, const LeafScatter& leaf) {
    area += weight;
    sum.projection += weight * leaf.projection;
    sum.towards += weight * leaf.towards;
    sum.lit += weight * leaf.lit;
    sum.unlit += weight * leaf.unlit;
  };
  for_picked_leaves(prototype, [&](const FoliageElement& e) {
    if (e.shape == ElementShape::kShoot) return add(e.area_m2, random);
    const Vec3 n = element_normal(e);
    const double seen = glm::dot(n, look), shown = std::abs(seen);
    const double lit = (seen > 0.0 ? -1.0 : 1.0) * glm::dot(n, to_light);
    add(e.area_m2, {shown, shown * lit, shown * std::max(lit, 0.0), shown * std::max(-lit, 0.0)});
  });
  if (!(area > 0.0)) return random;
  return {sum.projection / area, sum.towards / area, sum.lit / area, sum.unlit / area};
}

double leaf_turn_ratio(const Prototype& prototype, const Vec3& to_light) {
  double projected = 0.0, squared = 0.0;
  for_picked_leaves(prototype, [&](const FoliageElement& e) {
    const bool needles = e.shape == ElementShape::kShoot;
    const double cosine = needles ? 0.5 : std::abs(glm::dot(element_normal(e), to_light));
    projected += e.area_m2 * cosine;
    squared += e.area_m2 * (needles ? 1.0 / 3.0 : cosine * cosine);
  });
  return projected > 0.0 ? squared / projected : 2.0 / 3.0;
}

}  // namespace sunfleck
