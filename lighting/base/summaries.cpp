#include "lighting/base/summaries.h"

#include <time.h>

#include <cmath>
#include <span>

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

double clock_s(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double absorbed_w(const ElementLight& light, const LeafOptics& leaf, double area_m2) {
  return area_m2 * ((1.0 - leaf.albedo_front()) * light.front.total() +
                    (1.0 - leaf.albedo_back()) * light.back.total());
}

// One tree and band: absorbed flux of its elements and the sums of the tree.
TreeLight summarize_tree(const Forest& forest, const ForestIndex& index, const OpticsTable& optics,
                         std::size_t band, std::size_t instance, const LightMap& map,
                         std::span<ElementLight> elements) {
  const Instance& place = forest.instances[instance];
  const Prototype& prototype = forest.prototypes[place.prototype.value];
  const double area_scale = static_cast<double>(place.scale) * static_cast<double>(place.scale);
  TreeLight tree{.tree = place.tree, .instance = static_cast<std::uint32_t>(instance)};
  double received = 0.0;
  for (std::size_t i = 0; i < prototype.foliage.size(); ++i) {
    const FoliageElement& e = prototype.foliage[i];
    const double area_m2 = area_scale * e.area_m2;
    ElementLight& light = elements[i];
    const LeafOptics& leaf = optics.material(band, place.prototype, e.material).leaf;
    light.absorbed_w = static_cast<float>(absorbed_w(light, leaf, area_m2));
    tree.leaf_area_m2 += area_m2;
    tree.absorbed_w += absorbed_w(light, leaf, area_m2);
    tree.sunlit_leaf_area_m2 += area_m2 * map.sunlit_fraction[index.first_element(instance) + i];
    received += area_m2 * (static_cast<double>(light.front.total()) + light.back.total());
  }
  tree.mean_irradiance_w_m2 = tree.leaf_area_m2 > 0.0 ? received / tree.leaf_area_m2 : 0.0;
  return tree;
}

std::string face_violation(const FaceLight& face) {
  for (const float x : {face.direct_w_m2, face.sky_w_m2, face.scattered_w_m2}) {
    if (!std::isfinite(x)) return "an irradiance that is not finite";
    if (x < 0.0f) return "a negative irradiance";
  }
  return {};
}

std::string element_violation(const ElementLight& light) {
  for (const FaceLight& face : {light.front, light.back})
    if (std::string problem = face_violation(face); !problem.empty()) return problem;
  if (!std::isfinite(light.absorbed_w) || light.absorbed_w < 0.0f) return "a bad absorbed flux";
  return {};
}

std::string band_violation(const BandLightMap& band, std::size_t elements, std::size_t instances) {
  if (band.elements.size() != elements) return "a number of elements that is not the forest's";
  if (!band.standard_error_w_m2.empty() && band.standard_error_w_m2.size() != elements)
    return "standard errors that do not match its elements";
  if (band.trees.size() != instances) return "a number of trees that is not the forest's";
  for (const ElementLight& light : band.elements)
    if (std::string problem = element_violation(light); !problem.empty()) return problem;
  for (const float error : band.standard_error_w_m2)
    if (!std::isfinite(error) || error < 0.0f) return "a bad standard error";
  return {};
}

}  // namespace

void summarize(const Forest& forest, const ForestIndex& index, const OpticsTable& optics, LightMap& map) {
  SUNFLECK_EXPECTS(map.sunlit_fraction.size() == index.element_count());
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    BandLightMap& band = map.bands[b];
    SUNFLECK_EXPECTS(band.elements.size() == index.element_count());
    band.trees.resize(index.instance_count());
    for_each_chunk(index.instance_count(), 16, {}, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double standard_error = band.trees[i].absorbed_standard_error_w;
        const std::size_t first = index.first_element(i);
        band.trees[i] = summarize_tree(forest, index, optics, b, i, map,
                                       {band.elements.data() + first, index.first_element(i + 1) - first});
        band.trees[i].absorbed_standard_error_w = standard_error;
      }
    });
    double area = 0.0, received = 0.0;
    for (const TreeLight& tree : band.trees) {
      area += tree.leaf_area_m2;
      received += tree.leaf_area_m2 * tree.mean_irradiance_w_m2;
    }
    band.mean_irradiance_w_m2 = area > 0.0 ? received / area : 0.0;
  }
}

std::string find_violation(const LightMap& map, const ForestIndex& index) {
  if (map.sunlit_fraction.size() != index.element_count())
    return "the sunlit fractions do not match the forest";
  for (const float f : map.sunlit_fraction)
    if (!(f >= 0.0f && f <= 1.0f)) return "a sunlit fraction outside [0, 1]";
  for (const BandLightMap& band : map.bands)
    if (const std::string problem = band_violation(band, index.element_count(), index.instance_count());
        !problem.empty())
      return "band " + band.band + " has " + problem;
  return {};
}

StageTimer::StageTimer(Provenance& provenance, std::string stage)
    : provenance_(provenance),
      stage_(std::move(stage)),
      wall_start_s_(clock_s(CLOCK_MONOTONIC)),
      cpu_start_s_(clock_s(CLOCK_PROCESS_CPUTIME_ID)) {}

StageTimer::~StageTimer() {
  provenance_.times.push_back(
      {stage_, clock_s(CLOCK_MONOTONIC) - wall_start_s_, clock_s(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_s_});
}

}  // namespace sunfleck
