// Depths towards the sun, element by element and cell by cell; see sun_depths.h.
#include "lighting/slab/sun_depths.h"

#include <algorithm>
#include <array>

#include "lighting/slab/compensation_rows.h"
#include "lighting/slab/slab_rows.h"
#include "lighting/slab/sun_maps.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr std::size_t kPointsAtOnce = 8192;

// Points of an instance; sums are added to `before` and `behind`.
void add_neighbours(const SunMaps& maps, std::size_t instance, const std::vector<float>& x,
                    const std::vector<float>& y, const std::vector<float>& z, std::span<float> before,
                    std::span<float> behind, const RunControl& control) {
  const std::vector<Neighbour> around = maps.neighbours().around(instance);
  if (around.empty()) return;
  for (std::size_t first = 0; first < x.size(); first += kPointsAtOnce) {
    control.check();
    const std::size_t count = std::min(kPointsAtOnce, x.size() - first);
    maps.neighbours().add_at(around, maps.placed()[instance], std::span(x).subspan(first, count),
                             std::span(y).subspan(first, count), std::span(z).subspan(first, count),
                             before.subspan(first, count), behind.subspan(first, count));
  }
}

float mean_over(const std::vector<float>& values, const PrototypeGrid& grid, std::size_t cell) {
  float sum = 0.0f;
  for (std::uint32_t k = grid.first[cell]; k < grid.first[cell + 1]; ++k) sum += values[grid.elements[k]];
  return sum / static_cast<float>(grid.first[cell + 1] - grid.first[cell]);
}

}  // namespace

SunDepths measure_sun_depths(const Forest& forest, const ForestIndex& index, const Vec3& to_sun,
                             int map_resolution, const RunControl& control) {
  const SunMaps maps(forest, to_sun, map_resolution, control);
  SunDepths sun;
  sun.yaw_step_rad = maps.yaw_step_rad();
  sun.map_resolution = maps.resolution();
  sun.maps = maps.table().size();
  sun.texel_m = maps.coarsest_texel_m();
  sun.turn_ratio = maps.turn_ratio();
  sun.complete = maps.neighbours().complete();
  sun.before.resize(index.element_count());
  sun.behind.resize(index.element_count());
  for_each_chunk(forest.instances.size(), 1, control, "sun", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ElementRows& rows = maps.table().rows(forest.instances[i].prototype.value);
      const OwnDepths& own = maps.own(forest.instances[i]);
      const std::span<float> before = std::span(sun.before).subspan(index.first_element(i), rows.size()),
                             behind = std::span(sun.behind).subspan(index.first_element(i), rows.size());
      std::copy(own.before.begin(), own.before.end(), before.begin());
      std::copy(own.behind.begin(), own.behind.end(), behind.begin());
      add_neighbours(maps, i, rows.x_m, rows.y_m, rows.z_m, before, behind, control);
    }
  });
  return sun;
}

CellSun measure_cell_sun(const Forest& forest, const ForestGrids& grids, const Vec3& to_sun,
                         int map_resolution, const RunControl& control) {
  const SunMaps maps(forest, to_sun, map_resolution, control);
  std::vector<CellCentres> centres;
  for (const PrototypeGrid& grid : grids.prototypes) centres.emplace_back(grid);
  CellSun sun{std::vector<float>(grids.cells()), std::vector<float>(grids.cells()), maps.turn_ratio()};
  for_each_chunk(forest.instances.size(), 1, control, "sun", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t prototype = forest.instances[i].prototype.value;
      const PrototypeGrid& grid = grids.prototypes[prototype];
      const OwnDepths& own = maps.own(forest.instances[i]);
      const std::span<float> before = std::span(sun.before).subspan(grids.first_cell[i], grid.cells()),
                             behind = std::span(sun.behind).subspan(grids.first_cell[i], grid.cells());
      for (std::size_t c = 0; c < grid.cells(); ++c) {
        before[c] = mean_over(own.before, grid, c);
        behind[c] = mean_over(own.behind, grid, c);
      }
      add_neighbours(maps, i, centres[prototype].x, centres[prototype].y, centres[prototype].z, before,
                     behind, control);
    }
  });
  return sun;
}

ScatteredCells scattered_sunlight(const Forest& forest, const ForestGrids& grids, const CellSun& sun,
                                  const ResponseMedium& medium, const Vec3& to_sun,
                                  std::span<const float> compensation, const RunControl& control) {
  SkyResponse response{grids.cells(),
                       {medium.angles ? forest.terrain.normal() : to_sun},
                       std::vector<float>(grids.cells()),
                       std::vector<float>(grids.cells())};
  const double cosine = glm::dot(to_sun, forest.terrain.normal());
  const CanopyOptics mean = medium.angles ? forest_optics(forest, medium.optics) : CanopyOptics{};
  for_each_chunk(forest.instances.size(), 4, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = grids.first_cell[i], count = grids.first_cell[i + 1] - first;
      const auto before = std::span(sun.before).subspan(first, count),
                 behind = std::span(sun.behind).subspan(first, count);
      const auto down = std::span(response.down).subspan(first, count),
                 up = std::span(response.up).subspan(first, count);
      if (medium.angles)
        spp_h_row(before, behind,
                  medium.angles->medium(cosine, mean.absorption, mean.turn, medium.ground_albedo), down, up);
      else
        spp_row(before, behind,
                row_medium(medium.optics[forest.instances[i].prototype.value].medium(sun.turn_ratio[i],
                                                                                     medium.ground_albedo)),
                down, up);
    }
  });
  for (std::size_t i = 0; i < compensation.size(); ++i) {
    response.down[i] *= compensation[i];
    response.up[i] *= compensation[i];
  }
  const double strength = medium.angles ? medium.angles->fluence_scale(cosine) : 1.0;
  return scattered_sky_light(response, std::array{strength}, control);
}

CellSun mean_over_cells(const Forest& forest, const ForestIndex& index, const ForestGrids& grids,
                        const SunDepths& sun, const RunControl& control) {
  CellSun means{std::vector<float>(grids.cells()), std::vector<float>(grids.cells()), sun.turn_ratio};
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
