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

namespace {

// Sums over faces of the variance of their means: of independent rays, and from the means of their groups.
struct Variances {
  double independent = 0, grouped = 0;
  double gain() const { return independent > 0.0 ? std::clamp(grouped / independent, 0.02, 1.0) : 1.0; }
  // A face's sums and counts of its groups, and its sum of squares.
  void add(const GroupValues& sums, const GroupValues& counts, double squares) {
    double n = 0.0, sum = 0.0, between = 0.0, groups = 0.0;
    for (std::size_t g = 0; g < kGroups; ++g)
      n += counts[g], sum += sums[g], groups += counts[g] > 0.0 ? 1.0 : 0.0;
    const double mean = sum / n;
    for (std::size_t g = 0; g < kGroups; ++g)
      between += counts[g] > 0.0 ? std::pow(sums[g] - counts[g] * mean, 2) / counts[g] : 0.0;
    independent += std::max(0.0, squares - n * mean * mean) / (n * (n - 1.0));
    grouped += between / (n * (groups - 1.0));
  }
};

void add_face(const BandProblem& p, const Radiosity<1>& radiosity, std::size_t face, Variances& to) {
  GroupValues sums{}, counts{};
  double squares = std::pow(p.sources.diffuse_w_m2, 2) * p.matrix.sky_squares[face];
  for (std::size_t g = 0; g < kGroups; ++g) sums[g] = p.matrix.sky[face][g] * p.sources.diffuse_w_m2;
  const std::uint32_t* row = p.matrix.row(face);
  for (int k = 0; k < p.matrix.rays; ++k) {
    const double met = row[k] == p.receivers.ground_beyond()
                           ? p.sources.ground_beyond_w_m2
                           : static_cast<double>(radiosity.of_face[row[k]][0]);
    sums[group_of(face, k)] += met;
    counts[group_of(face, k)] += 1.0;
    squares += met * met;
  }
  to.add(sums, counts, squares);
}

// Light of both faces of an element.
void add_sun(const BandProblem& p, std::size_t element, Variances& to) {
  const std::size_t face = p.receivers.first_face(element);
  GroupValues sums{}, counts{};
  double sum = 0.0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    sums[g] = static_cast<double>(p.sun.received[face][g]) + p.sun.received[face + 1][g];
    counts[g] = rays_in_group(p.sun.rays, element, g);
    sum += sums[g];
  }
  // Every visible ray brings about the same.
  to.add(sums, counts, p.sun.visible[element] > 0 ? sum * sum / p.sun.visible[element] : 0.0);
}

}  // namespace

bool is_shoot(const Receivers& receivers, std::size_t element) {
  const ForestIndex::Place place = receivers.index().place(element);
  const Forest& forest = receivers.forest();
  return forest.prototypes[forest.instances[place.instance].prototype.value].foliage[place.local].shape ==
         ElementShape::kShoot;
}

ShapeGains spread_gains(const BandProblem& p, const Radiosity<1>& radiosity) {
  constexpr std::size_t kElements = 4096;
  constexpr int kFewestRays = 2 * kSequences;
  std::array<Variances, 2> rays, sun;  // of leaves, of shoots
  const std::size_t elements = p.receivers.foliage_count();
  const std::size_t step = std::max<std::size_t>(1, elements / kElements);
  for (std::size_t e = 0; e < elements; e += step) {
    const std::size_t shape = is_shoot(p.receivers, e) ? 1 : 0;
    if (p.matrix.rays >= kFewestRays)
      for (const std::size_t side : {0u, 1u})
        add_face(p, radiosity, p.receivers.first_face(e) + side, rays[shape]);
    if (p.sun.rays >= kFewestRays) add_sun(p, e, sun[shape]);
  }
  return {{rays[0].gain(), sun[0].gain()}, {rays[1].gain(), sun[1].gain()}};
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
