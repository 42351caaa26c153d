// Depths towards the sun, element by element; see sun_depths.h.
#include "lighting/slab/sun_depths.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "lighting/slab/compensation_rows.h"
#include "lighting/slab/map_table.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMapBytes = std::size_t{1} << 30;
constexpr std::size_t kExactYaws = 256;
constexpr int kYawSteps = 64;

// The yaw an instance's map is made for.
class SunYaws {
 public:
  explicit SunYaws(const Forest& forest) {
    if (forest.instances.empty()) return;
    base_rad_ = forest.instances.front().yaw_rad;
    std::set<std::pair<std::uint32_t, float>> different;
    for (const Instance& i : forest.instances) {
      different.insert({i.prototype.value, i.yaw_rad});
      if (different.size() > kExactYaws) break;
    }
    if (different.size() > kExactYaws) step_rad_ = 2.0 * kPi / kYawSteps;
  }
  double step_rad() const { return step_rad_; }
  double yaw_rad(const Instance& i) const {
    if (step_rad_ == 0.0) return i.yaw_rad;
    return base_rad_ + step_rad_ * static_cast<double>(step(i));
  }
  std::uint64_t key(const Instance& i) const {
    return step_rad_ == 0.0 ? std::bit_cast<std::uint32_t>(i.yaw_rad) : step(i);
  }

 private:
  std::uint64_t step(const Instance& i) const {
    const double turns = (i.yaw_rad - base_rad_) / (2.0 * kPi);
    return static_cast<std::uint64_t>(std::lround((turns - std::floor(turns)) * kYawSteps)) % kYawSteps;
  }
  double base_rad_ = 0, step_rad_ = 0;
};

std::vector<MapWish> sun_wishes(const Forest& forest, const SunYaws& yaws, const Vec3& to_sun) {
  std::vector<MapWish> wishes;
  std::set<std::pair<std::uint32_t, std::uint64_t>> seen;
  for (const Instance& i : forest.instances) {
    if (!seen.insert({i.prototype.value, yaws.key(i)}).second) continue;
    const double c = std::cos(yaws.yaw_rad(i)), s = std::sin(yaws.yaw_rad(i));
    wishes.push_back({i.prototype.value,
                      yaws.key(i),
                      {c * to_sun.x + s * to_sun.y, c * to_sun.y - s * to_sun.x, to_sun.z}});
  }
  return wishes;
}

int affordable_resolution(const Forest& forest, const std::vector<MapWish>& wishes, int resolution) {
  for (; resolution > 8; resolution /= 2) {
    std::size_t bytes = 0;
    for (const MapWish& w : wishes)
      bytes += opacity_map_bytes(opacity_layout(forest.prototypes[w.prototype], w.to_light, resolution));
    if (bytes <= kMapBytes) break;
  }
  return std::max(resolution, 8);
}

// Elements [begin, end) of the forest, which may span instances.
void fill_elements(const Forest& forest, const ForestIndex& index, std::span<const PlacedMap> placed,
                   const OpacityNeighbours& neighbours, std::size_t begin, std::size_t end, SunDepths& sun) {
  ForestIndex::Place place = index.place(begin);
  std::vector<Neighbour> around = neighbours.around(place.instance);
  for (std::size_t e = begin; e < end; ++e, ++place.local) {
    if (e >= index.first_element(place.instance + 1)) {
      place = index.place(e);
      around = neighbours.around(place.instance);
    }
    const PlacedMap& own = placed[place.instance];
    const FoliageElement& element =
        forest.prototypes[forest.instances[place.instance].prototype.value].foliage[place.local];
    const OpticalDepths inside = own.map->around(element);
    const OpticalDepths beyond = neighbours.at(around, own.world_from_tree(Vec3(element.centre_m)));
    sun.before[e] = static_cast<float>(inside.before + beyond.before);
    sun.behind[e] = static_cast<float>(inside.behind + beyond.behind);
  }
}

}  // namespace

SunDepths measure_sun_depths(const Forest& forest, const ForestIndex& index, const Vec3& to_sun,
                             int map_resolution, const RunControl& control) {
  SunDepths sun;
  const SunYaws yaws(forest);
  const std::vector<MapWish> wishes = sun_wishes(forest, yaws, to_sun);
  sun.yaw_step_rad = yaws.step_rad();
  sun.map_resolution = affordable_resolution(forest, wishes, map_resolution);
  const MapTable maps(forest, wishes, sun.map_resolution, control, "sun maps");
  sun.maps = maps.size();

  std::vector<Box> bounds;
  for (const Prototype& p : forest.prototypes) bounds.push_back(prototype_bounds(p));
  std::vector<PlacedMap> placed;
  for (const Instance& i : forest.instances) {
    const OpacityMap& map = maps.at(i.prototype.value, yaws.key(i));
    placed.push_back(place_map(i, map, bounds[i.prototype.value], yaws.yaw_rad(i), forest_origin(forest)));
    sun.texel_m = std::max(sun.texel_m, map.layout().texel_m * i.scale);
    sun.turn_ratio.push_back(static_cast<float>(
        map.leaf_projection() > 0.0 ? map.mean_square_cosine() / map.leaf_projection() : 2.0 / 3.0));
  }
  const OpacityNeighbours neighbours(forest, placed, to_sun);
  sun.complete = neighbours.complete();
  sun.before.resize(index.element_count());
  sun.behind.resize(index.element_count());
  for_each_chunk(index.element_count(), 1024, control, "sun", [&](std::size_t begin, std::size_t end) {
    fill_elements(forest, index, placed, neighbours, begin, end, sun);
  });
  return sun;
}

CellSun mean_over_cells(const Forest& forest, const ForestIndex& index, const ForestGrids& grids,
                        const SunDepths& sun, const RunControl& control) {
  CellSun means{std::vector<float>(grids.cells()), std::vector<float>(grids.cells())};
  for_each_chunk(forest.instances.size(), 4, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const PrototypeGrid& grid = grids.prototypes[forest.instances[i].prototype.value];
      const float *before = sun.before.data() + index.first_element(i),
                  *behind = sun.behind.data() + index.first_element(i);
      for (std::size_t c = 0; c < grid.cells(); ++c) {
        double sum_before = 0.0, sum_behind = 0.0;
        for (std::uint32_t k = grid.first[c]; k < grid.first[c + 1]; ++k) {
          sum_before += before[grid.elements[k]];
          sum_behind += behind[grid.elements[k]];
        }
        const double n = grid.first[c + 1] - grid.first[c];
        means.before[grids.first_cell[i] + c] = static_cast<float>(sum_before / n);
        means.behind[grids.first_cell[i] + c] = static_cast<float>(sum_behind / n);
      }
    }
  });
  return means;
}

std::vector<float> sun_compensation(const CellDepths& cells, const CellSun& sun, const Vec3& to_sun,
                                    const RunControl& control) {
  std::vector<float> result(cells.cells);
  for_each_chunk(cells.cells, 2048, control, "compensation", [&](std::size_t begin, std::size_t end) {
    compensation_rows(cells, to_sun, sun.before, sun.behind, begin, end, result);
  });
  return result;
}

}  // namespace sunfleck
