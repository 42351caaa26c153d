#include "lighting/plan/auto_groups.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr std::size_t kPerDraw = 8;
constexpr double kLeastArea_m2 = 1e-300;  // elements of no area can be drawn where there are no others

// Height above the ground; what lies below counts as on it.
std::vector<double> heights_m(const Forest& forest, const ForestIndex& index) {
  std::vector<double> heights(index.element_count());
  for (std::size_t i = 0, e = 0; i < forest.instances.size(); ++i)
    for (std::size_t k = 0; k < index.first_element(i + 1) - index.first_element(i); ++k, ++e) {
      const Vec3 at = world_element(forest, i, k).centre_m;
      heights[e] = std::max(0.0, at.z - forest.terrain.height_at(at.x, at.y));
    }
  return heights;
}

std::vector<std::uint32_t> layers_of(const Forest& forest, const ForestIndex& index, const AutoOptions& o) {
  constexpr double kMostLayers = 1e6;
  const std::vector<double> heights = heights_m(forest, index);
  const double top = *std::max_element(heights.begin(), heights.end());
  const double count = o.layers > 0 ? o.layers : std::clamp(std::ceil(top / o.layer_m), 1.0, kMostLayers);
  const double thickness = o.layers > 0 ? top / count : o.layer_m;
  std::vector<std::uint32_t> layers(heights.size());
  for (std::size_t e = 0; e < heights.size(); ++e)
    layers[e] =
        thickness > 0.0 ? static_cast<std::uint32_t>(std::min(count - 1.0, heights[e] / thickness)) : 0;
  return layers;
}

std::vector<std::uint32_t> trees_of(const ForestIndex& index) {
  std::vector<std::uint32_t> trees(index.element_count());
  for (std::size_t i = 0; i < index.instance_count(); ++i)
    std::fill(trees.begin() + static_cast<std::ptrdiff_t>(index.first_element(i)),
              trees.begin() + static_cast<std::ptrdiff_t>(index.first_element(i + 1)),
              static_cast<std::uint32_t>(i));
  return trees;
}

double absorbed_w_m2(const LeafOptics& leaf, double front, double back) {
  return (1.0 - leaf.albedo_front()) * front + (1.0 - leaf.albedo_back()) * back;
}

}  // namespace

bool is_of_groups(AutoMeasure measure) {
  return measure == AutoMeasure::kTreeRms || measure == AutoMeasure::kTreeAbsorbedRms ||
         measure == AutoMeasure::kLayerRms;
}

ElementGroups element_groups(const Forest& forest, const ForestIndex& index, const AutoOptions& options) {
  const std::vector<std::uint32_t> group_of =
      options.measure == AutoMeasure::kLayerRms ? layers_of(forest, index, options) : trees_of(index);
  std::vector<std::uint32_t> order(group_of.size());
  for (std::size_t e = 0; e < order.size(); ++e) order[e] = static_cast<std::uint32_t>(e);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return group_of[a] < group_of[b]; });
  ElementGroups groups;
  double area = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || group_of[order[k]] != group_of[order[k - 1]]) {
      groups.first.push_back(k);
      area = 0.0;
    }
    const auto place = index.place(order[k]);
    area += std::max(kLeastArea_m2, world_element(forest, place.instance, place.local).area_m2);
    groups.area_below_m2.push_back(area);
  }
  groups.first.push_back(order.size());
  groups.element = std::move(order);
  return groups;
}

GroupProbes draw_group_probes(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
                              const ProbePlan& plan, const AutoOptions& options, const RunControl& control) {
  GroupProbes drawn;
  drawn.groups = element_groups(scene.receivers().forest(), scene.receivers().index(), options);
  SUNFLECK_EXPECTS(drawn.groups.first.size() >= 2);
  drawn.per_draw = kPerDraw;
  RandomStream random(plan.seed, 1, RandomPurpose::kProbeDraw);
  std::vector<std::size_t> elements;
  const std::size_t draws = std::max<std::size_t>(2, static_cast<std::size_t>(plan.count) / kPerDraw);
  for (std::size_t d = 0; d < draws; ++d) {
    const std::uint32_t group = random.below(static_cast<std::uint32_t>(drawn.groups.count()));
    drawn.group_of_draw.push_back(group);
    const auto first =
        drawn.groups.area_below_m2.begin() + static_cast<std::ptrdiff_t>(drawn.groups.first[group]);
    const auto end =
        drawn.groups.area_below_m2.begin() + static_cast<std::ptrdiff_t>(drawn.groups.first[group + 1]);
    for (std::size_t k = 0; k < kPerDraw; ++k) {
      const double at = random.uniform() * drawn.groups.area_m2(group);
      const auto found = std::min(std::upper_bound(first, end, at), end - 1);
      elements.push_back(
          drawn.groups.element[static_cast<std::size_t>(found - drawn.groups.area_below_m2.begin())]);
    }
  }
  // Another seed than that of the element probes, which corrections are fitted to.
  drawn.probes.probes = probe_light(scene, optics, light, elements,
                                    {mix_seed(plan.seed, 1), plan.paths_per_face, plan.sun_rays}, control);
  for (const std::size_t e : elements) drawn.probes.area_m2.push_back(scene.receivers().area_m2(e));
  return drawn;
}

namespace {

// An element's share of the quantity that a measure is on, per area.
class Quantity {
 public:
  Quantity(const Forest& forest, const ForestIndex& index, const OpticsTable& optics, std::size_t band,
           bool absorbed)
      : forest_(forest), index_(index), optics_(optics), band_(band), absorbed_(absorbed) {}

  double of(std::size_t element, double front, double back) const {
    if (!absorbed_) return front + back;
    const auto place = index_.place(element);
    const PrototypeId prototype = forest_.instances[place.instance].prototype;
    const auto material = forest_.prototypes[prototype.value].foliage[place.local].material;
    return absorbed_w_m2(optics_.material(band_, prototype, material).leaf, front, back);
  }

 private:
  const Forest& forest_;
  const ForestIndex& index_;
  const OpticsTable& optics_;
  const std::size_t band_;
  const bool absorbed_;
};

double mean_over_groups(const ElementGroups& groups, const BandLightMap& map, const Quantity& quantity,
                        bool absorbed) {
  double sum = 0.0;
  for (std::size_t g = 0; g < groups.count(); ++g) {
    double group = 0.0, below = 0.0;
    for (std::size_t k = groups.first[g]; k < groups.first[g + 1]; ++k) {
      const ElementLight& e = map.elements[groups.element[k]];
      group +=
          (groups.area_below_m2[k] - below) * quantity.of(groups.element[k], e.front.total(), e.back.total());
      below = groups.area_below_m2[k];
    }
    sum += absorbed ? group : group / groups.area_m2(g);
  }
  return sum / static_cast<double>(groups.count());
}

}  // namespace

ErrorSample sample_group_error(const GroupProbes& drawn, const Forest& forest, const ForestIndex& index,
                               const OpticsTable& optics, const BandLightMap& map, std::size_t band,
                               AutoMeasure measure) {
  const bool absorbed = measure == AutoMeasure::kTreeAbsorbedRms;
  const Quantity quantity(forest, index, optics, band, absorbed);
  ErrorSample sample;
  const auto n = static_cast<double>(drawn.per_draw);
  for (std::size_t d = 0; d < drawn.group_of_draw.size(); ++d) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = d * drawn.per_draw; k < (d + 1) * drawn.per_draw; ++k) {
      const ProbeLight& truth = drawn.probes.probes[k];
      const ElementLight& e = map.elements[truth.element];
      const double error = quantity.of(truth.element, e.front.total() - truth.bands[band].front.total(),
                                       e.back.total() - truth.bands[band].back.total());
      sum += error;
      squares += error * error;
    }
    const double scale = absorbed ? drawn.groups.area_m2(drawn.group_of_draw[d]) : 1.0;
    sample.difference_w_m2.push_back(scale * sum / n);
    sample.variance_w2_m4.push_back(scale * scale * std::max(0.0, squares - sum * sum / n) / (n * (n - 1.0)));
    sample.area_m2.push_back(1.0);
  }
  sample.mean_w_m2 = sample.area_mean_w_m2 = mean_over_groups(drawn.groups, map, quantity, absorbed);
  return sample;
}

}  // namespace sunfleck
