// Where radiance is swept: directions, grid, sweep plans and the ground around it. Knows nothing of what the
// cells hold.
#pragma once

#include <memory>

#include "lighting/depth/grid_frame.h"
#include "lighting/transport/ground_map.h"
#include "lighting/transport/sky_sectors.h"
#include "lighting/transport/sweep.h"

namespace sunfleck::transport {

struct SweepSpace {
  DirectionSet set;
  GridFrame frame;
  GridLayout layout;
  std::vector<SweepPlan> plans;  // per direction
  std::unique_ptr<GroundMap> ground;
  bool periodic = false;

  std::size_t cells() const { return layout.cell_count(); }
  template <class T>
  std::span<T> part_of(std::vector<T>& radiance, std::size_t direction) const {
    return {radiance.data() + direction * cells(), cells()};
  }
  // Way from slab to slab over the edge of a cell, per direction.
  std::vector<double> step_cells() const;
};

// Directions that suit a scene: `directions` is 8, 14 or 26. Layered ones (none level) for endless scenes and
// for those much wider than high: what scatters close to level leaves a wide stand through its top or ends on
// its floor; level directions would keep it among the leaves to the far side (light of the sun scattered in a
// stand of 25 trees came out 9 % high).
DirectionSet directions_for(const Forest& forest, int directions);

// Fills `plans`.
void plan_sweeps(SweepSpace& space);

class EvenInflow final : public Inflow {
 public:
  explicit EvenInflow(double radiance) : radiance_(static_cast<float>(radiance)) {}
  float radiance(const std::array<int, 3>&) const override { return radiance_; }

 private:
  float radiance_;
};

// Radiance from outside that reaches each cell without meeting anything, along one direction. Returns what
// goes around where the axis repeats, see sweep().
std::vector<float> sweep_even(const SweepPlan& plan, std::span<const float> half_step_transmittance,
                              const Inflow& inflow, std::span<float> radiance, const RunControl& control,
                              CellValue value = CellValue::kMiddle);

// Irradiance of every ground cell by `radiance` [direction][cell]; where the way to the outside misses the
// grid, `outside` per direction.
std::vector<float> ground_irradiance(const SweepSpace& space, const SkySectors& sectors,
                                     std::span<const float> radiance, std::span<const double> outside,
                                     const RunControl& control);

// Radiance that the ground sends into the grid from one direction.
class GroundInflow final : public Inflow {
 public:
  // `ground_radiance` per ground cell, `open_radiance` beyond the map.
  GroundInflow(const SweepSpace& space, const SkySectors& sectors, std::size_t direction,
               std::span<const float> ground_radiance, float open_radiance);
  float radiance(const std::array<int, 3>& cell) const override;

 private:
  const SweepSpace& space_;
  std::span<const float> ground_radiance_;
  Vec3 towards_;
  float share_, open_radiance_;
  bool hits_map_;
};

}  // namespace sunfleck::transport
