// See leaf_angles.h.
#include "lighting/envelope/leaf_angles.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lighting/envelope/closed_forms.h"
#include "sim/base/contract.h"

namespace sunfleck::envelope {

namespace {

constexpr std::size_t kMostSamples = 16384;  // of all prototypes together
constexpr std::size_t kMostPerPrototype = 4096, kFewestPerPrototype = 256;

// Needles of a shoot light each other: the mean share of light from inside that leaves it.
double mean_escape(const FieldElement& e) {
  double sum = 0.0;
  for (const Direction<double>& w : cube_directions<double>()) sum += own_transmittance(e, w) / 8.0;
  return sum;
}

// Mean over directions of the projected area of a prototype's wood: a quarter of its surface.
double mean_wood_projection_m2(const Prototype& prototype) {
  double sum = 0.0;
  for (const WoodSegment& s : prototype.wood)
    sum += 0.25 * kPi * (s.radius_from_m + s.radius_to_m) * glm::length(Vec3(s.to_m) - Vec3(s.from_m));
  for (const WoodTriangle& t : prototype.wood_mesh)
    sum += 0.125 * glm::length(glm::cross(Vec3(t.b_m - t.a_m), Vec3(t.c_m - t.a_m)));
  return sum;
}

// Gathers elements of one prototype by material.
class Sampler {
 public:
  explicit Sampler(EnvelopeAngles angles) : angles_(angles) {}

  void add(std::uint16_t material, const FieldElement& e) {
    AngleSample& sample = samples_[material];
    sample.material = material;
    sample.area_m2 += e.area_m2;
    const bool even = e.is_shoot() || angles_ == EnvelopeAngles::kSpherical;
    escaping_m2_[material] += e.area_m2 * mean_escape(e);
    if (even)
      sample.even_share += e.area_m2;
    else
      sample.leaves.push_back({Vec3f(e.axis), e.area_m2});
  }

  std::vector<AngleSample> result() {
    std::vector<AngleSample> found;
    for (auto& [material, sample] : samples_) {
      if (!(sample.area_m2 > 0.0)) continue;
      sample.escape = escaping_m2_[material] / sample.area_m2;
      sample.even_share /= sample.area_m2;
      found.push_back(std::move(sample));
    }
    return found;
  }

 private:
  const EnvelopeAngles angles_;
  std::map<std::uint16_t, AngleSample> samples_;
  std::map<std::uint16_t, double> escaping_m2_;
};

double projected_leaf_area_m2(const PrototypeAngles& angles) {
  double sum = 0.0;
  for (const AngleSample& s : angles.samples) sum += 0.5 * s.area_m2 * s.escape;
  return sum;
}

// Every how manieth element of each prototype is looked at.
std::vector<std::size_t> sampling_steps(const Forest& forest) {
  const std::size_t share = kMostSamples / std::max<std::size_t>(1, forest.prototypes.size());
  const std::size_t wanted = std::clamp(share, kFewestPerPrototype, kMostPerPrototype);
  std::vector<std::size_t> elements(forest.prototypes.size(), 0);
  for (const Instance& i : forest.instances)
    elements[i.prototype.value] += forest.prototypes[i.prototype.value].foliage.size();
  for (std::size_t& n : elements) n = std::max<std::size_t>(1, n / wanted);
  return elements;
}

// m(v, w) of uniformly turned leaves for every pair, Eq. 31.
double even_pair(const Vec3& v, const Vec3& w) {
  return mean_transmitting_cosines(angle_between<double>(v, w));
}

// Calls visit(share, positive cosines of all directions of the set) for every leaf of the sample; the shares
// and the even share sum to 1.
template <class Visit>
void for_each_leaf(const AngleSample& sample, const SectorSet& set, const Visit& visit) {
  double area = 0.0;
  for (const SampledLeaf& leaf : sample.leaves) area += leaf.area_m2;
  std::vector<double> cosines(set.count());
  for (const SampledLeaf& leaf : sample.leaves) {
    for (std::size_t j = 0; j < set.half(); ++j) {
      const double cosine = glm::dot(Vec3(leaf.normal), set.to_source[j]);
      cosines[j] = std::max(0.0, cosine);
      cosines[set.half() + j] = std::max(0.0, -cosine);
    }
    visit((1.0 - sample.even_share) * leaf.area_m2 / area, Vec3(leaf.normal), cosines);
  }
}

}  // namespace

std::vector<PrototypeAngles> measure_leaf_angles(const Forest& forest, const ForestIndex& index,
                                                 const BlockerField& field, EnvelopeAngles angles,
                                                 const RunControl& control) {
  std::vector<Sampler> samplers(forest.prototypes.size(), Sampler(angles));
  const std::vector<std::size_t> steps = sampling_steps(forest);
  std::vector<std::size_t> next(forest.prototypes.size(), 0);  // elements to pass over before the next one
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    control.check();
    const std::size_t p = forest.instances[i].prototype.value, first = index.first_element(i);
    const std::vector<FoliageElement>& foliage = forest.prototypes[p].foliage;
    std::size_t local = next[p];
    for (; local < foliage.size(); local += steps[p])
      samplers[p].add(foliage[local].material, field.elements()[first + local]);
    next[p] = local - foliage.size();
  }
  std::vector<PrototypeAngles> result(forest.prototypes.size());
  for (std::size_t p = 0; p < result.size(); ++p) {
    result[p].samples = samplers[p].result();
    double sampled = 0.0, leaf = 0.0;
    for (const AngleSample& s : result[p].samples) sampled += s.area_m2;
    for (const FoliageElement& e : forest.prototypes[p].foliage) leaf += e.area_m2;
    const double wood = mean_wood_projection_m2(forest.prototypes[p]);
    const double leaves = sampled > 0.0 ? projected_leaf_area_m2(result[p]) * leaf / sampled : 0.0;
    result[p].wood_share = wood > 0.0 ? wood / (wood + leaves) : 0.0;
  }
  return result;
}

AngleMoments angle_moments(const AngleSample& sample, const SectorSet& set) {
  const std::size_t n = set.count();
  AngleMoments moments{.facing = std::vector<double>(n, 0.25 * sample.even_share),
                       .pairs = std::vector<double>(n * n)};
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < n && sample.even_share > 0.0; ++k)
      moments.pairs[j * n + k] = sample.even_share * even_pair(set.to_source[j], set.to_source[k]);
  }
  for_each_leaf(sample, set, [&](double share, const Vec3&, const std::vector<double>& cosines) {
    for (std::size_t j = 0; j < n; ++j) {
      if (cosines[j] == 0.0) continue;
      const double factor = share * cosines[j];
      moments.facing[j] += factor;
      for (std::size_t k = 0; k < n; ++k) moments.pairs[j * n + k] += factor * cosines[k];
    }
  });
  return moments;
}

LightMoments light_moments(const AngleSample& sample, const SectorSet& set, const Vec3& direction) {
  const std::size_t n = set.count();
  LightMoments moments{.facing_towards = 0.25 * sample.even_share,
                       .facing_away = 0.25 * sample.even_share,
                       .towards = std::vector<double>(n),
                       .away = std::vector<double>(n)};
  for (std::size_t j = 0; j < n && sample.even_share > 0.0; ++j) {
    moments.towards[j] = sample.even_share * even_pair(set.to_source[j], direction);
    moments.away[j] = sample.even_share * even_pair(set.to_source[j], -direction);
  }
  for_each_leaf(sample, set, [&](double share, const Vec3& normal, const std::vector<double>& cosines) {
    const double cosine = glm::dot(normal, direction);
    (cosine > 0.0 ? moments.facing_towards : moments.facing_away) += share * std::abs(cosine);
    std::vector<double>& side = cosine > 0.0 ? moments.towards : moments.away;
    for (std::size_t j = 0; j < n; ++j) side[j] += share * std::abs(cosine) * cosines[j];
  });
  return moments;
}

}  // namespace sunfleck::envelope
