// See sweep_space.h.
#include "lighting/transport/sweep_space.h"

#include <algorithm>
#include <cmath>

#include "lighting/depth/grid_march.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

// A light level that changes by less than this from one round of a periodic scene to the next has settled.
constexpr float kSettled = 1e-5f;

// Wider than this times its height, a forest is a layer rather than a crown.
constexpr double kWide = 1.5;

float largest_change(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return 1.0f;
  float change = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) change = std::max(change, std::abs(a[i] - b[i]));
  return change;
}

// A level line leaves it later than lines a little above or below.
bool is_wide(const Forest& forest) {
  const Vec3 size = forest_bounds(forest).size();
  return std::sqrt(size.x * size.y) > kWide * size.z;
}

}  // namespace

std::vector<double> SweepSpace::step_cells() const {
  std::vector<double> steps;
  for (const SweepPlan& plan : plans) steps.push_back(plan.step_m / layout.mean_cell_m());
  return steps;
}

DirectionSet directions_for(const Forest& forest, int directions) {
  return forest.period || is_wide(forest) ? layered_directions(directions, forest.terrain.normal())
                                          : cubic_directions(directions);
}

void plan_sweeps(SweepSpace& space) {
  space.plans.clear();
  for (const Vec3& w : space.set.to_source)
    space.plans.push_back(plan_sweep(space.layout, space.frame.field_direction(w)));
}

std::vector<float> sweep_even(const SweepPlan& plan, std::span<const float> half_step_transmittance,
                              const Inflow& inflow, std::span<float> radiance, const RunControl& control,
                              CellValue value) {
  const bool around = plan.wraps[static_cast<std::size_t>(plan.axis)];
  std::vector<float> leaving, before;
  for (int round = 0; round < (around ? kMostWraps : 1); ++round) {
    before = leaving;
    std::ranges::fill(radiance, 0.0f);
    sweep(plan, half_step_transmittance, inflow, radiance, leaving, control, value);
    if (largest_change(leaving, before) <= kSettled) break;
  }
  return leaving;
}

std::vector<float> ground_irradiance(const SweepSpace& space, const SkySectors& sectors,
                                     std::span<const float> radiance, std::span<const double> outside,
                                     const RunControl& control) {
  std::vector<float> irradiance(space.ground->count());
  for_each_chunk(irradiance.size(), 4096, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      double sum = 0.0;
      for (std::size_t d = 0; d < space.set.count(); ++d) {
        const double weight = sectors.ground_weight_sr[d];
        if (weight == 0.0) continue;
        const std::int32_t entry = space.ground->entry(g, d);
        sum += weight *
               (entry == GroundMap::kOpen
                    ? outside[d]
                    : static_cast<double>(radiance[d * space.cells() + static_cast<std::size_t>(entry)]));
      }
      irradiance[g] = static_cast<float>(sum);
    }
  });
  return irradiance;
}

GroundInflow::GroundInflow(const SweepSpace& space, const SkySectors& sectors, std::size_t direction,
                           std::span<const float> ground_radiance, float open_radiance)
    : space_(space),
      ground_radiance_(ground_radiance),
      towards_(space.frame.field_direction(space.set.to_source[direction])),
      share_(static_cast<float>(sectors.ground_share[direction])),
      open_radiance_(open_radiance),
      hits_map_(space.frame.ends_on_ground(space.set.to_source[direction])) {}

float GroundInflow::radiance(const std::array<int, 3>& cell) const {
  if (share_ == 0.0f) return 0.0f;
  if (!hits_map_) return share_ * open_radiance_;
  const Vec3 centre = space_.layout.lo_m + (Vec3(cell[0], cell[1], cell[2]) + 0.5) * space_.layout.cell_m;
  const std::int32_t hit = space_.ground->hit(centre, towards_);
  return share_ *
         (hit == GroundMap::kOpen ? open_radiance_ : ground_radiance_[static_cast<std::size_t>(hit)]);
}

}  // namespace sunfleck::transport
