// Depths of all cells in all sample directions, axis by axis; see cell_depths.h.
#include "lighting/slab/cell_depths.h"

#include <algorithm>
#include <utility>

#include "lighting/depth/exp_pair.h"
#include "lighting/slab/map_table.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr double kMapBytesAtOnce = 512e6;

// The compensation factor compares depths by ratios: where nothing is in the way all have to be exactly 0,
// not the faint edge of some leaf.
float stored_depth(float depth) { return depth < 1e-6f ? 0.0f : depth; }

// In the maps of the tree itself, for one of its cells.
struct OwnCell {
  float before = 0, behind = 0, transmission = 1;
};

std::vector<OwnCell> measure_own_cells(const Prototype& prototype, const ElementRows& rows,
                                       const PrototypeGrid& grid, const OpacityMap& map,
                                       const RunControl& control) {
  std::vector<float> before(rows.size()), behind(rows.size());
  constexpr std::size_t kElementsAtOnce = 65536;
  for (std::size_t e = 0; e < rows.size(); e += kElementsAtOnce) {
    control.check();
    map.around_all(prototype, rows, e, std::min(e + kElementsAtOnce, rows.size()), before, behind);
  }
  std::vector<OwnCell> cells(grid.cells());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    float sum_before = 0.0f, sum_behind = 0.0f, transmission = 0.0f;
    for (std::uint32_t k = grid.first[c]; k < grid.first[c + 1]; ++k) {
      const std::uint32_t e = grid.elements[k];
      sum_before += before[e];
      sum_behind += behind[e];
      transmission += exp_pair(before[e]).falling;
    }
    const float n = static_cast<float>(grid.first[c + 1] - grid.first[c]);
    cells[c] = {sum_before / n, sum_behind / n, transmission / n};
  }
  return cells;
}

// One run of the preprocessing.
class Measurement {
 public:
  Measurement(const Forest& forest, const ForestGrids& grids, int map_resolution, const RunControl& control,
              CellDepths& result)
      : forest_(forest),
        grids_(grids),
        resolution_(map_resolution),
        control_(control),
        result_(result),
        origin_m_(forest_origin(forest)) {
    for (const Prototype& p : forest.prototypes) bounds_.push_back(prototype_bounds(p));
    for (const PrototypeGrid& grid : grids.prototypes) centres_.emplace_back(grid);
  }

  void run() {
    const std::size_t axes = result_.directions.axes();
    for (std::size_t first = 0; first < axes;) {
      std::size_t last = first;
      std::vector<MapWish> wishes = wishes_of(last++);
      for (; last < axes; ++last) {  // as many axes at once as their maps find room
        std::vector<MapWish> more = wishes_of(last);
        if (!have_room(wishes.size() + more.size())) break;
        wishes.insert(wishes.end(), more.begin(), more.end());
      }
      measure_axes(first, last, wishes);
      first = last;
    }
  }

 private:
  bool have_room(std::size_t maps) const {
    const double side = resolution_ + 5.0;
    return static_cast<double>(maps) * side * side * side * sizeof(float) <= kMapBytesAtOnce;
  }

  int step_of(std::size_t instance) const {
    return result_.directions.step_of(forest_.instances[instance].yaw_rad);
  }

  // Without repetition inside the axis.
  std::vector<MapWish> wishes_of(std::size_t axis) const {
    const SampleDirections& d = result_.directions;
    std::vector<char> seen(forest_.prototypes.size() * d.keys(), 0);
    std::vector<MapWish> wishes;
    for (std::size_t i = 0; i < forest_.instances.size(); ++i) {
      const std::uint32_t prototype = forest_.instances[i].prototype.value;
      const std::size_t key = d.key(axis, step_of(i));
      if (std::exchange(seen[prototype * d.keys() + key], 1) == 0)
        wishes.push_back({prototype, key, d.local(axis, step_of(i))});
    }
    return wishes;
  }

  void measure_axes(std::size_t first, std::size_t last, const std::vector<MapWish>& wishes) {
    const MapTable maps(forest_, wishes, resolution_, control_, "opacity maps");
    std::vector<std::vector<OwnCell>> own(maps.size());
    for_each_chunk(maps.size(), 1, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m)
        own[m] = measure_own_cells(forest_.prototypes[maps.prototype(m)], maps.rows(maps.prototype(m)),
                                   grids_.prototypes[maps.prototype(m)], maps.map(m),
                                   RunControl{control_.stop, {}});
    });
    for (const MapWish& w : wishes) {
      const OpacityMap& map = maps.at(w.prototype, w.key);
      result_.turn_ratio[w.prototype * result_.directions.keys() + w.key] = static_cast<float>(
          map.leaf_projection() > 0.0 ? map.mean_square_cosine() / map.leaf_projection() : 2.0 / 3.0);
    }
    for (std::size_t axis = first; axis < last; ++axis) sum_over_forest(axis, maps, own);
  }

  // [SPP] Eq. 31 for all cells and one axis.
  void sum_over_forest(std::size_t axis, const MapTable& maps, const std::vector<std::vector<OwnCell>>& own) {
    const SampleDirections& d = result_.directions;
    std::vector<PlacedMap> placed;
    std::vector<std::size_t> map_of;
    for (std::size_t i = 0; i < forest_.instances.size(); ++i) {
      const Instance& instance = forest_.instances[i];
      const std::uint32_t prototype = instance.prototype.value;
      map_of.push_back(maps.index(prototype, d.key(axis, step_of(i))));
      const double yaw = d.is_vertical(axis) ? static_cast<double>(instance.yaw_rad) : d.yaw_rad(step_of(i));
      placed.push_back(place_map(instance, maps.map(map_of[i]), bounds_[prototype], yaw, origin_m_));
    }
    const OpacityNeighbours neighbours(forest_, placed, d.upward(axis));
    result_.complete = result_.complete && neighbours.complete();
    for_each_chunk(forest_.instances.size(), 1, control_, {}, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) fill_instance(i, axis, placed[i], neighbours, own[map_of[i]]);
    });
  }

  void fill_instance(std::size_t i, std::size_t axis, const PlacedMap& placed,
                     const OpacityNeighbours& neighbours, const std::vector<OwnCell>& own) {
    const std::size_t axes = result_.directions.axes(), first = grids_.first_cell[i];
    float* before = result_.depth.data() + axis * result_.cells + first;
    float* behind = result_.depth.data() + (axes + axis) * result_.cells + first;
    float* transmission = result_.transmission.data() + axis * result_.cells + first;
    const PrototypeGrid& grid = grids_.prototypes[forest_.instances[i].prototype.value];
    const CellCentres& centres = centres_[forest_.instances[i].prototype.value];
    std::vector<float> beyond_before(grid.cells(), 0.0f), beyond_behind(grid.cells(), 0.0f);
    neighbours.add_at(neighbours.around(i), placed, centres.x, centres.y, centres.z, beyond_before,
                      beyond_behind);
    for (std::size_t c = 0; c < grid.cells(); ++c) {
      before[c] = stored_depth(own[c].before + beyond_before[c]);
      behind[c] = stored_depth(own[c].behind + beyond_behind[c]);
      transmission[c] = own[c].transmission * exp_pair(beyond_before[c]).falling;
    }
  }

  const Forest& forest_;
  const ForestGrids& grids_;
  int resolution_;
  const RunControl& control_;
  CellDepths& result_;
  Vec3 origin_m_;
  std::vector<Box> bounds_;
  std::vector<CellCentres> centres_;
};

}  // namespace

CellDepths measure_cell_depths(const Forest& forest, const ForestGrids& grids, int sample_directions,
                               int map_resolution, const RunControl& control) {
  const double base_yaw_rad = forest.instances.empty() ? 0.0 : forest.instances.front().yaw_rad;
  CellDepths result{SampleDirections(sample_directions, base_yaw_rad), grids.cells(), {}, {}, {}, true};
  result.depth.resize(grids.cells() * result.directions.directions());
  result.transmission.resize(grids.cells() * result.directions.axes());
  result.turn_ratio.assign(forest.prototypes.size() * result.directions.keys(), 2.0f / 3.0f);
  Measurement(forest, grids, map_resolution, control, result).run();
  return result;
}

}  // namespace sunfleck
