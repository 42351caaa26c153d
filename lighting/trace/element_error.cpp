#include "lighting/trace/element_error.h"

#include <algorithm>

namespace sunfleck::trace {
namespace {

struct RaySums {
  double sum = 0, squares = 0;
  double sky = 0;
  int lost = 0;
};

RaySums sums_of(const BandProblem& p, const Radiosity<1>& radiosity, std::size_t face) {
  const double diffuse = p.sources.diffuse_w_m2, beyond = p.sources.ground_beyond_w_m2;
  RaySums s;
  for (std::size_t g = 0; g < kGroups; ++g) {
    s.sky += p.matrix.sky[face][g] * diffuse;
    s.lost += p.matrix.lost[face][g];
  }
  s.sum = s.sky;
  s.squares = diffuse * diffuse * p.matrix.sky_squares[face];
  const std::uint32_t* row = p.matrix.row(face);
  for (int k = 0; k < p.matrix.rays; ++k) {
    const double met =
        row[k] == p.receivers.ground_beyond() ? beyond : static_cast<double>(radiosity.of_face[row[k]][0]);
    s.sum += met;
    s.squares += met * met;
  }
  return s;
}

}  // namespace

double own_ray_variance(const BandProblem& p, const Radiosity<1>& radiosity, std::size_t face,
                        double typical_radiosity_w_m2) {
  const double rays = p.matrix.rays;
  if (rays < 2.0) return 0.0;
  const RaySums s = sums_of(p, radiosity, face);
  const double mean = s.sum / rays;
  double variance = std::max(0.0, s.squares / rays - mean * mean) / (rays - 1.0);
  // All alike: the next ray may still be of the other kind.
  if (s.lost == 0 || s.lost == p.matrix.rays) {
    const double other = s.lost == 0 ? p.sources.diffuse_w_m2 : typical_radiosity_w_m2;
    variance += fraction_variance(0.0, rays) * (mean - other) * (mean - other);
  }
  return variance;
}

double fraction_variance(double seen, double rays) {
  const double part = (seen + 0.5) / (rays + 1.0);
  return part * (1.0 - part) / rays;
}

double sun_variance(const BandProblem& p, std::size_t element, const Vec3& to_sun) {
  if (p.sun.rays == 0) return 0.0;
  const ForestIndex::Place place = p.receivers.index().place(element);
  const Forest& forest = p.receivers.forest();
  const Instance& instance = forest.instances[place.instance];
  const FoliageElement& e = forest.prototypes[instance.prototype.value].foliage[place.local];
  // Light of a visible ray on both faces together.
  const double cosine =
      e.shape == ElementShape::kShoot
          ? 0.5
          : std::abs(glm::dot(world_direction_from_tree(instance, element_normal(e)), to_sun));
  const double light = p.sources.beam_w_m2 * cosine;
  return light * light * fraction_variance(p.sun.visible[element], p.sun.rays);
}

}  // namespace sunfleck::trace
