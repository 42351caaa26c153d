// Depths leaf by leaf and the refined form; see spp_marched.h.
#include "lighting/slab/spp_marched.h"

#include <algorithm>
#include <cmath>

#include "lighting/depth/blocker_field.h"
#include "lighting/depth/extinction_grid.h"
#include "lighting/slab/leaf_scatter.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

// Every element a cell of its own.
ForestGrids element_grids(const Forest& forest, const ForestIndex& index) {
  ForestGrids grids;
  for (const Prototype& prototype : forest.prototypes) {
    PrototypeGrid& grid = grids.prototypes.emplace_back();
    for (std::uint32_t e = 0; e < prototype.foliage.size(); ++e) {
      grid.cell_of_element.push_back(e);
      grid.elements.push_back(e);
      grid.first.push_back(e);
      grid.centre_m.push_back(Vec3(prototype.foliage[e].centre_m));
    }
    grid.first.push_back(static_cast<std::uint32_t>(prototype.foliage.size()));
  }
  for (std::size_t i = 0; i <= forest.instances.size(); ++i)
    grids.first_cell.push_back(index.first_element(i));
  return grids;
}

void measure_turn_ratios(const Forest& forest, CellDepths& cells) {
  const SampleDirections& d = cells.directions;
  cells.turn_ratio.assign(forest.prototypes.size() * d.keys(), 2.0f / 3.0f);
  std::vector<char> done(cells.turn_ratio.size(), 0);
  for (const Instance& i : forest.instances)
    for (std::size_t axis = 0; axis < d.axes(); ++axis) {
      const int step = d.step_of(i.yaw_rad);
      const std::size_t at = i.prototype.value * d.keys() + d.key(axis, step);
      if (std::exchange(done[at], 1) == 0)
        cells.turn_ratio[at] =
            static_cast<float>(leaf_turn_ratio(forest.prototypes[i.prototype.value], d.local(axis, step)));
    }
}

// A direction as seen from the leaves of one instance.
struct Look {
  Vec3 direction;  // world
  SlabLine line;   // without its end
  ScatterShares shares;
};

class RefinedSun {
 public:
  RefinedSun(const Forest& forest, const SppPrepared& prepared, const SunDepths& sun, const Vec3& to_sun,
             const std::vector<CanopyOptics>& optics, double ground_albedo)
      : forest_(forest),
        prepared_(prepared),
        sun_(sun),
        to_sun_(to_sun),
        optics_(optics),
        ground_albedo_(ground_albedo) {}

  std::vector<Look> looks(std::size_t instance) const {
    const Instance& place = forest_.instances[instance];
    const Prototype& prototype = forest_.prototypes[place.prototype.value];
    const bool real_angles = prepared_.options.marched.phase == SppPhase::kLeafAngles;
    const Vec3 local_sun = tree_direction_from_world(place, to_sun_);
    const double sun_projection = leaf_scatter(prototype, local_sun, local_sun).projection;
    const SampleDirections& d = prepared_.cells.directions;
    std::vector<Look> looks;
    for (std::size_t j = 0; j < d.directions(); ++j) {
      Look look{d.direction(j), {}, {}};
      look.line.cosine = std::clamp(glm::dot(look.direction, to_sun_), -1.0, 1.0);
      look.line.rate = 1.0 / std::max(std::abs(look.line.cosine), 1e-6);
      look.line.meets_ground = glm::dot(look.direction, forest_.terrain.normal()) < 0.0 || !ends_truly();
      const double isotropic = 1.0 / (4.0 * kPi);
      look.shares = {isotropic, isotropic, isotropic};
      if (real_angles) {
        const LeafScatter scatter =
            leaf_scatter(prototype, tree_direction_from_world(place, look.direction), local_sun);
        look.shares = scatter.shares(optics_[place.prototype.value].turn);
        if (sun_projection > 0.0 && scatter.projection > 0.0)
          look.line.rate *= scatter.projection / sun_projection;
      }
      looks.push_back(look);
    }
    return looks;
  }

  // Element e of the forest; `normal` 0 for needles.
  std::pair<double, double> faces(std::size_t e, std::size_t instance, const Vec3& normal,
                                  const std::vector<Look>& looks) const {
    const CanopyOptics& optics = optics_[forest_.instances[instance].prototype.value];
    const RefinedSlab slab(sun_.before[e], sun_.behind[e],
                           optics.medium(sun_.turn_ratio[instance], ground_albedo_));
    const bool needles = normal == Vec3(0.0);
    double front = 0.0, back = 0.0, front_weight = 0.0, back_weight = 0.0;
    for (std::size_t j = 0; j < looks.size(); ++j) {
      SlabLine line = looks[j].line;
      if (ends_truly()) line.true_end = prepared_.cells.depths(j)[e];
      const double radiance = slab.radiance(line, looks[j].shares);
      const double cosine = needles ? 0.0 : glm::dot(normal, looks[j].direction);
      const double to_front = needles ? 1.0 : std::max(cosine, 0.0);
      const double to_back = needles ? 1.0 : std::max(-cosine, 0.0);
      front += to_front * radiance;
      back += to_back * radiance;
      front_weight += to_front;
      back_weight += to_back;
    }
    // Even radiance gives exactly pi times itself, whatever the directions.
    return {front_weight > 0.0 ? kPi * front / front_weight : 0.0,
            back_weight > 0.0 ? kPi * back / back_weight : 0.0};
  }

 private:
  bool ends_truly() const { return prepared_.options.marched.paths == SppPaths::kTrueBoundary; }

  const Forest& forest_;
  const SppPrepared& prepared_;
  const SunDepths& sun_;
  const Vec3 to_sun_;
  const std::vector<CanopyOptics>& optics_;
  const double ground_albedo_;
};

}  // namespace

void prepare_marched_depths(const Forest& forest, SppPrepared& prepared, const RunControl& control) {
  const ForestIndex index(forest);
  prepared.grids = element_grids(forest, index);
  CellDepths& cells = prepared.cells;
  const double base_yaw_rad = forest.instances.empty() ? 0.0 : forest.instances.front().yaw_rad;
  cells = {SampleDirections(prepared.options.sample_directions, base_yaw_rad),
           index.element_count(),
           {},
           {},
           {},
           true};
  measure_turn_ratios(forest, cells);
  if (cells.cells == 0) return;
  prepared.blockers = std::make_shared<BlockerField>(
      forest, BlockerFieldOptions{prepared.options.marched.cell_m, BlockerFieldOptions{}.max_cells}, control);
  const std::size_t axes = cells.directions.axes();
  cells.depth.resize(2 * axes * cells.cells);
  cells.transmission.resize(axes * cells.cells);
  ExtinctionGrid grid(*prepared.blockers, cells.directions.upward(0), control);
  for (std::size_t axis = 0; axis < axes; ++axis) {
    control.report("marching", static_cast<double>(axis) / static_cast<double>(axes));
    if (axis > 0) grid.turn_to(cells.directions.upward(axis), control);
    const RunControl quiet{control.stop, {}};
    const std::vector<float> before = grid.depth_of_elements(March::kForward, quiet);
    const std::vector<float> behind = grid.depth_of_elements(March::kBackward, quiet);
    const auto at = [&](std::vector<float>& rows, std::size_t row) {
      return rows.begin() + static_cast<std::ptrdiff_t>(row * cells.cells);
    };
    std::copy(before.begin(), before.end(), at(cells.depth, axis));
    std::copy(behind.begin(), behind.end(), at(cells.depth, axes + axis));
    std::transform(before.begin(), before.end(), at(cells.transmission, axis),
                   [](float depth) { return std::exp(-depth); });
  }
}

SunDepths march_sun_depths(const Forest& forest, const SppPrepared& prepared, const Vec3& to_sun,
                           const RunControl& control) {
  SunDepths sun;
  const ExtinctionGrid grid(*prepared.blockers, to_sun, control);
  sun.before = grid.depth_of_elements(March::kForward, control);
  sun.behind = grid.depth_of_elements(March::kBackward, control);
  sun.texel_m = prepared.blockers->layout().mean_cell_m();
  for (const Instance& i : forest.instances)
    sun.turn_ratio.push_back(static_cast<float>(
        leaf_turn_ratio(forest.prototypes[i.prototype.value], tree_direction_from_world(i, to_sun))));
  return sun;
}

FaceResponse refined_sunlight(const Forest& forest, const SppPrepared& prepared, const SunDepths& sun,
                              const Vec3& to_sun, const std::vector<CanopyOptics>& optics,
                              double ground_albedo, const RunControl& control) {
  const RefinedSun refined(forest, prepared, sun, to_sun, optics, ground_albedo);
  const ForestIndex index(forest);
  FaceResponse response{std::vector<float>(sun.before.size()), std::vector<float>(sun.before.size())};
  for_each_chunk(index.element_count(), 1024, control, "sun", [&](std::size_t begin, std::size_t end) {
    ForestIndex::Place place = index.place(begin);
    std::vector<Look> looks = refined.looks(place.instance);
    for (std::size_t e = begin; e < end; ++e, ++place.local) {
      if (e >= index.first_element(place.instance + 1)) {
        place = index.place(e);
        looks = refined.looks(place.instance);
      }
      const Instance& instance = forest.instances[place.instance];
      const FoliageElement& element = forest.prototypes[instance.prototype.value].foliage[place.local];
      const Vec3 normal = element.shape == ElementShape::kShoot
                              ? Vec3(0.0)
                              : world_direction_from_tree(instance, element_normal(element));
      const auto [front, back] = refined.faces(e, place.instance, normal, looks);
      response.front[e] = static_cast<float>(front);
      response.back[e] = static_cast<float>(back);
    }
  });
  return response;
}

}  // namespace sunfleck
