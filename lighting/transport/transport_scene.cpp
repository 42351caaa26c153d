// See transport_scene.h.
#include "lighting/transport/transport_scene.h"

#include <algorithm>
#include <cmath>

#include "lighting/depth/extinction_grid.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

constexpr std::uint64_t kMostBytes = 3ull << 29;
// A light level that changes by less than this from one round of a periodic scene to the next has settled.
constexpr float kSettled = 1e-5f;

// Three arrays of every direction: sky, light on its way, and (for half) transmittance.
std::uint64_t cells_that_fit(const DirectionSet& set) {
  return kMostBytes / (sizeof(float) * 5 * set.half() + sizeof(std::uint32_t));
}

class EvenInflow final : public Inflow {
 public:
  explicit EvenInflow(double radiance) : radiance_(static_cast<float>(radiance)) {}
  float radiance(const std::array<int, 3>&) const override { return radiance_; }

 private:
  float radiance_;
};

float largest_change(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return 1.0f;
  float change = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) change = std::max(change, std::abs(a[i] - b[i]));
  return change;
}

void sweep_sky(const TransportScene& scene, std::size_t direction, std::span<float> radiance,
               const RunControl& control) {
  const EvenInflow inflow(scene.sectors.sky_radiance[direction]);
  const SweepPlan& plan = scene.plans[direction];
  const bool around = plan.wraps[static_cast<std::size_t>(plan.axis)];
  std::vector<float> leaving, before;
  for (int round = 0; round < (around ? kMostWraps : 1); ++round) {
    before = leaving;
    std::ranges::fill(radiance, 0.0f);
    sweep(plan, scene.transmittance_of(direction), inflow, radiance, leaving, control);
    if (largest_change(leaving, before) <= kSettled) break;
  }
}

}  // namespace

TransportScene transport_scene(const Forest& forest, const ForestIndex& index, const Illumination& light,
                               int directions, double cell_m, const RunControl& control) {
  TransportScene scene;
  scene.periodic = forest.period.has_value();
  scene.set =
      scene.periodic ? layered_directions(directions, forest.terrain.normal()) : cubic_directions(directions);
  const BlockerFieldOptions options{.cell_m = cell_m, .max_cells = cells_that_fit(scene.set)};
  scene.field = std::make_unique<BlockerField>(forest, options, control);
  std::vector<double> step_cells;
  for (const Vec3& w : scene.set.to_source) {
    scene.plans.push_back(plan_sweep(scene.field->layout(), scene.field->field_direction(w)));
    step_cells.push_back(scene.plans.back().step_m / scene.field->layout().mean_cell_m());
  }
  scene.lanes = direction_lanes(scene.set, step_cells);
  scene.contents = cell_contents(forest, index, *scene.field, scene.set, scene.lanes, light.to_sun, control);
  scene.transmittance = half_step_transmittance(scene.contents, scene.lanes, scene.set.half(), control);
  scene.sectors = sky_sectors(scene.set, light.sky, forest.terrain.normal());
  scene.ground = std::make_unique<GroundMap>(forest, *scene.field, scene.set, control);
  return scene;
}

std::vector<float> sky_radiance(const TransportScene& scene, const RunControl& control) {
  std::vector<float> radiance(scene.set.count() * scene.cells());
  for_each_chunk(scene.set.count(), 1, control, {}, [&](std::size_t d, std::size_t) {
    if (scene.sectors.sky_radiance[d] > 0.0) sweep_sky(scene, d, scene.part_of(radiance, d), control);
  });
  return radiance;
}

std::vector<float> ground_irradiance(const TransportScene& scene, std::span<const float> radiance,
                                     std::span<const double> outside, const RunControl& control) {
  std::vector<float> irradiance(scene.ground->count());
  for_each_chunk(irradiance.size(), 4096, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      double sum = 0.0;
      for (std::size_t d = 0; d < scene.set.count(); ++d) {
        const double weight = scene.sectors.ground_weight_sr[d];
        if (weight == 0.0) continue;
        const std::int32_t entry = scene.ground->entry(g, d);
        sum += weight *
               (entry == GroundMap::kOpen
                    ? outside[d]
                    : static_cast<double>(radiance[d * scene.cells() + static_cast<std::size_t>(entry)]));
      }
      irradiance[g] = static_cast<float>(sum);
    }
  });
  return irradiance;
}

GroundInflow::GroundInflow(const TransportScene& scene, std::size_t direction,
                           std::span<const float> ground_radiance, float open_radiance)
    : scene_(scene),
      ground_radiance_(ground_radiance),
      towards_(scene.field->field_direction(scene.set.to_source[direction])),
      share_(static_cast<float>(scene.sectors.ground_share[direction])),
      open_radiance_(open_radiance),
      hits_map_(scene.field->ends_on_ground(scene.set.to_source[direction])) {}

float GroundInflow::radiance(const std::array<int, 3>& cell) const {
  if (share_ == 0.0f) return 0.0f;
  if (!hits_map_) return share_ * open_radiance_;
  const GridLayout& layout = scene_.field->layout();
  const Vec3 centre = layout.lo_m + (Vec3(cell[0], cell[1], cell[2]) + 0.5) * layout.cell_m;
  const std::int32_t hit = scene_.ground->hit(centre, towards_);
  return share_ *
         (hit == GroundMap::kOpen ? open_radiance_ : ground_radiance_[static_cast<std::size_t>(hit)]);
}

}  // namespace sunfleck::transport
