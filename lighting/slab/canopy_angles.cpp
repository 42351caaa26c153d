// Leaf angles against the ground; see canopy_angles.h.
#include "lighting/slab/canopy_angles.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

constexpr std::size_t kMostLeaves = 4096;
constexpr std::size_t kAngleBins = 64;

// <|n.s|> over azimuth for a leaf and a light at cosines a and mu to the vertical (Warren Wilson 1967).
double mean_over_azimuth(double a, double mu) {
  const double level = a * mu;
  const double swing = std::sqrt(std::max(0.0, (1.0 - a * a) * (1.0 - mu * mu)));
  if (swing <= std::abs(level)) return std::abs(level);
  const double turn = std::acos(std::clamp(-level / swing, -1.0, 1.0));
  return std::abs(2.0 / kPi * (level * (turn - 0.5 * kPi) + swing * std::sin(turn)));
}

// Leaf area by |n.N| in bins of equal width, with the mean |n.N| of each; and of needles.
struct AngleCount {
  std::array<double, kAngleBins> area_m2{}, cosine_area_m2{}, square_area_m2{};
  double needles_m2 = 0.0;
};

void add_prototype(const Prototype& prototype, const Vec3& normal, double weight, AngleCount& count) {
  const std::size_t leaves = prototype.foliage.size(), step = leaves / kMostLeaves + 1;
  for (std::size_t i = 0; i < leaves; i += step) {
    const FoliageElement& e = prototype.foliage[i];
    const double area = weight * e.area_m2 * static_cast<double>(step);
    if (e.shape == ElementShape::kShoot) {
      count.needles_m2 += area;
      continue;
    }
    const double cosine = std::abs(glm::dot(element_normal(e), normal));
    const double bin = std::min(cosine * kAngleBins, kAngleBins - 1.0);
    if (!(bin >= 0.0)) continue;
    const std::size_t k = static_cast<std::size_t>(bin);
    count.area_m2[k] += area;
    count.cosine_area_m2[k] += area * cosine;
    count.square_area_m2[k] += area * cosine * cosine;
  }
}

// On level ground yaw changes nothing and prototypes are counted once; on a slope each of 16 yaws.
AngleCount count_angles(const Forest& forest) {
  AngleCount count;
  std::vector<double> weight(forest.prototypes.size(), 0.0);
  for (const Instance& i : forest.instances)
    weight[i.prototype.value] += static_cast<double>(i.scale) * static_cast<double>(i.scale);
  const Vec3 n = forest.terrain.normal();
  const int yaws = n.z > 1.0 - 1e-12 ? 1 : 16;
  const double level = std::hypot(n.x, n.y);
  for (std::size_t p = 0; p < weight.size(); ++p)
    for (int k = 0; weight[p] > 0.0 && k < yaws; ++k) {
      const double yaw = 2.0 * kPi * k / yaws;
      add_prototype(forest.prototypes[p], {level * std::cos(yaw), level * std::sin(yaw), n.z}, weight[p],
                    count);
    }
  return count;
}

}  // namespace

CanopyAngles::CanopyAngles(const Forest& forest) {
  const AngleCount count = count_angles(forest);
  double area = count.needles_m2, squares = count.needles_m2 / 3.0;
  projection_.fill(0.5 * count.needles_m2);
  for (std::size_t bin = 0; bin < kAngleBins; ++bin) {
    if (!(count.area_m2[bin] > 0.0)) continue;
    const double leaf = std::min(count.cosine_area_m2[bin] / count.area_m2[bin], 1.0);
    area += count.area_m2[bin];
    squares += count.square_area_m2[bin];
    for (std::size_t k = 0; k <= kSteps; ++k)
      projection_[k] += count.area_m2[bin] * mean_over_azimuth(leaf, static_cast<double>(k) / kSteps);
  }
  if (!(area > 0.0)) {  // randomly turned, for want of leaves
    projection_.fill(0.5);
    return;
  }
  mean_square_cosine_ = squares / area;
  for (double& p : projection_) p = std::clamp(p / area, 1e-3, 1.0);
  constexpr int kPoints = 256;
  diffuse_cosine_ = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double mu = (i + 0.5) / kPoints;
    diffuse_cosine_ += mu / leaf_projection(mu) / kPoints;
  }
}

double CanopyAngles::leaf_projection(double cosine) const {
  const double at = std::clamp(std::abs(cosine), 0.0, 1.0) * kSteps;
  const std::size_t k = std::min(static_cast<std::size_t>(at), kSteps - 1);
  const double part = at - static_cast<double>(k);
  return (1.0 - part) * projection_[k] + part * projection_[k + 1];
}

HemisphereMedium CanopyAngles::medium(double cosine, double absorption, double turn,
                                      double ground_albedo) const {
  const double mu = std::clamp(cosine, 1e-4, 1.0), projection = leaf_projection(mu);
  const double beam = 0.5 + 0.5 * turn * mean_square_cosine_ * mu / projection;
  const double diffuse = 0.5 + 0.5 * turn * mean_square_cosine_;
  return {absorption, std::clamp(beam, 0.0, 1.0), std::clamp(diffuse, 0.0, 1.0), ground_albedo,
          diffuse_cosine_ * projection / mu};
}

}  // namespace sunfleck
