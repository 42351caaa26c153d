// See leaf_projection.h. Leaves are counted in steps of inclination of 0.1 degrees first.
#include "lighting/canopy/leaf_projection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunfleck {

namespace {

constexpr std::size_t kSteps = 900;

struct LeafInclinations {
  std::array<double, kSteps> area_m2{};
  double shoots_m2 = 0, total_m2 = 0;
};

void add_leaves(const Prototype& prototype, double times, LeafInclinations& sums) {
  if (!(times > 0.0)) return;
  for (const FoliageElement& e : prototype.foliage) {
    const double area = times * e.area_m2;
    sums.total_m2 += area;
    if (e.shape == ElementShape::kShoot) {
      sums.shoots_m2 += area;
      continue;
    }
    const double inclination = std::acos(std::min(1.0, std::abs(element_normal(e).z)));
    const auto step = static_cast<std::size_t>(inclination / (0.5 * kPi) * kSteps);
    sums.area_m2[std::min(step, kSteps - 1)] += area;
  }
}

}  // namespace

double mean_leaf_cosine(double inclination_rad, double zenith_rad) {
  const double along = std::cos(inclination_rad) * std::cos(zenith_rad);
  const double across = std::sin(inclination_rad) * std::sin(zenith_rad);
  if (along >= across) return along;
  const double psi = std::acos(along / across);
  return along + 2.0 / kPi * (across * std::sin(psi) - along * psi);
}

std::vector<double> leaf_projection(const Forest& forest, std::span<const double> zenith_rad) {
  // A turn about the vertical changes no inclination, a scale every area alike.
  std::vector<double> times(forest.prototypes.size(), 0.0);
  for (const Instance& i : forest.instances)
    times[i.prototype.value] += static_cast<double>(i.scale) * i.scale;
  LeafInclinations sums;
  for (std::size_t p = 0; p < times.size(); ++p) add_leaves(forest.prototypes[p], times[p], sums);
  std::vector<double> out(zenith_rad.size(), 0.0);
  if (!(sums.total_m2 > 0.0)) return out;
  for (std::size_t z = 0; z < out.size(); ++z) {
    out[z] = 0.5 * sums.shoots_m2;
    for (std::size_t k = 0; k < kSteps; ++k)
      if (sums.area_m2[k] > 0.0)
        out[z] += sums.area_m2[k] *
                  mean_leaf_cosine((static_cast<double>(k) + 0.5) / kSteps * 0.5 * kPi, zenith_rad[z]);
    out[z] /= sums.total_m2;
  }
  return out;
}

}  // namespace sunfleck
