// Sky light cell by cell; see sky_light.h.
#include "lighting/slab/sky_light.h"

#include <cmath>

#include "lighting/slab/compensation_rows.h"
#include "lighting/slab/slab_rows.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr std::size_t kCellsAtOnce = 2048;

// Media of every (prototype, key of direction), made once for all instances.
std::vector<SppRowMedium> row_media(const CellDepths& cells, const ResponseMedium& medium) {
  std::vector<SppRowMedium> rows;
  const std::size_t keys = cells.directions.keys();
  for (std::size_t i = 0; i < cells.turn_ratio.size(); ++i)
    rows.push_back(row_medium(medium.optics[i / keys].medium(cells.turn_ratio[i], medium.ground_albedo)));
  return rows;
}

void multiply(std::span<const float> factor, std::span<float> down, std::span<float> up) {
  for (std::size_t i = 0; i < factor.size(); ++i) {
    down[i] *= factor[i];
    up[i] *= factor[i];
  }
}

Vec3 source_axis(const Forest& forest, const CellDepths& cells, const ResponseMedium& medium, std::size_t s) {
  return medium.angles ? forest.terrain.normal() : cells.directions.upward(s);
}

ScatteredCells no_light(std::size_t cells) {
  ScatteredCells none;
  for (std::vector<float>* v : {&none.sum, &none.drift_x, &none.drift_y, &none.drift_z}) v->resize(cells);
  return none;
}

// Visits ranges of cells, each with evaluate(s, down, up): the fluences that source s of strength 1 leaves in
// the cells of the range, without compensation; false where the source is behind the slope.
template <class Visit>
void spp_ranges(const Forest& forest, const ForestGrids& grids, const CellDepths& cells,
                const ResponseMedium& medium, const RunControl& control, const Visit& visit) {
  const SampleDirections& d = cells.directions;
  const std::vector<SppRowMedium> media = row_media(cells, medium);
  for_each_chunk(forest.instances.size(), 4, control, "sky", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Instance& instance = forest.instances[i];
      const std::size_t first = grids.first_cell[i], count = grids.first_cell[i + 1] - first;
      const int step = d.step_of(instance.yaw_rad);
      visit(first, count, [&](std::size_t s, std::span<float> down, std::span<float> up) {
        spp_row(cells.depths(s).subspan(first, count), cells.depths(d.axes() + s).subspan(first, count),
                media[instance.prototype.value * d.keys() + d.key(s, step)], down, up);
        return true;
      });
    }
  });
}

template <class Visit>
void spp_h_ranges(const Forest& forest, const CellDepths& cells, const ResponseMedium& medium,
                  const RunControl& control, const Visit& visit) {
  const SampleDirections& d = cells.directions;
  const CanopyOptics mean = forest_optics(forest, medium.optics);
  std::vector<double> cosine(d.axes());
  std::vector<HemisphereMedium> media(d.axes());
  std::vector<float> strength(d.axes());
  for (std::size_t s = 0; s < d.axes(); ++s) {
    cosine[s] = glm::dot(d.upward(s), forest.terrain.normal());
    if (!(cosine[s] > 0.0)) continue;  // no sky behind the slope
    media[s] = medium.angles->medium(cosine[s], mean.absorption, mean.turn, medium.ground_albedo);
    strength[s] = static_cast<float>(medium.angles->fluence_scale(cosine[s]));
  }
  for_each_chunk(cells.cells, kCellsAtOnce, control, "sky", [&](std::size_t first, std::size_t end) {
    const std::size_t count = end - first;
    visit(first, count, [&](std::size_t s, std::span<float> down, std::span<float> up) {
      if (!(cosine[s] > 0.0)) return false;
      spp_h_row(cells.depths(s).subspan(first, count), cells.depths(d.axes() + s).subspan(first, count),
                media[s], down, up);
      for (float& f : down) f *= strength[s];
      for (float& f : up) f *= strength[s];
      return true;
    });
  });
}

template <class Visit>
void for_each_range(const Forest& forest, const ForestGrids& grids, const CellDepths& cells,
                    const ResponseMedium& medium, const RunControl& control, const Visit& visit) {
  SUNFLECK_EXPECTS(medium.optics.size() == forest.prototypes.size());
  if (medium.angles)
    spp_h_ranges(forest, cells, medium, control, visit);
  else
    spp_ranges(forest, grids, cells, medium, control, visit);
}

// Adds `sum` (down + up) to the sums of cells from `first` on and x, y, z (down - up) to their drifts.
struct SourceWeights {
  float sum, x, y, z;
};
SourceWeights weights_of(double source, const Vec3& axis) {
  const Vec3f drift(source * axis);
  return {static_cast<float>(source), drift.x, drift.y, drift.z};
}
void add_source(const float* __restrict down, const float* __restrict up, const SourceWeights& w,
                std::size_t first, std::size_t count, ScatteredCells& to) {
  float *__restrict sum = to.sum.data() + first, *__restrict x = to.drift_x.data() + first,
                    *__restrict y = to.drift_y.data() + first, *__restrict z = to.drift_z.data() + first;
  for (std::size_t i = 0; i < count; ++i) {
    const float difference = down[i] - up[i];
    sum[i] += w.sum * (down[i] + up[i]);
    x[i] += w.x * difference;
    y[i] += w.y * difference;
    z[i] += w.z * difference;
  }
}

}  // namespace

std::vector<double> sky_sources(const SampleDirections& directions, const SkyRadiance& sky,
                                const Vec3& ground_normal) {
  std::vector<double> sources;
  double on_plane = 0.0;
  for (std::size_t j = 0; j < directions.axes(); ++j) {
    const double cos_zenith = directions.upward(j).z;
    sources.push_back(sky.ring_mean(cos_zenith));
    on_plane += sources.back() * cos_zenith;
  }
  for (std::size_t j = 0; j < directions.axes(); ++j)
    sources[j] = glm::dot(directions.upward(j), ground_normal) > 0.0 ? sources[j] / on_plane : 0.0;
  return sources;
}

std::vector<float> sky_compensation(const CellDepths& cells, const RunControl& control) {
  const std::size_t axes = cells.directions.axes();
  std::vector<float> result(cells.cells * axes);
  for_each_chunk(cells.cells, kCellsAtOnce, control, "compensation", [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = 0; s < axes; ++s) {
      control.check();
      compensation_rows(cells, cells.directions.upward(s), cells.depths(s), cells.depths(axes + s), begin,
                        end, std::span(result).subspan(s * cells.cells, cells.cells));
    }
  });
  return result;
}

CanopyOptics forest_optics(const Forest& forest, std::span<const CanopyOptics> optics) {
  std::vector<double> weight(forest.prototypes.size(), 0.0), area(forest.prototypes.size(), 0.0);
  for (const Instance& i : forest.instances)
    weight[i.prototype.value] += static_cast<double>(i.scale) * static_cast<double>(i.scale);
  double sum = 0.0;
  CanopyOptics mean{0.0, 0.0};
  for (std::size_t p = 0; p < weight.size(); ++p) {
    for (const FoliageElement& e : forest.prototypes[p].foliage) area[p] += weight[p] * e.area_m2;
    sum += area[p];
    mean.absorption += area[p] * optics[p].absorption;
    mean.turn += area[p] * optics[p].turn;
  }
  if (!(sum > 0.0)) return {};
  return {std::clamp(mean.absorption / sum, 0.0, 1.0), std::clamp(mean.turn / sum, -1.0, 1.0)};
}

SkyResponse sky_response(const Forest& forest, const ForestGrids& grids, const CellDepths& cells,
                         const ResponseMedium& medium, std::span<const float> compensation,
                         const RunControl& control) {
  const std::size_t axes = cells.directions.axes();
  SkyResponse response{
      cells.cells, {}, std::vector<float>(axes * cells.cells), std::vector<float>(axes * cells.cells)};
  for (std::size_t s = 0; s < axes; ++s) response.axes.push_back(source_axis(forest, cells, medium, s));
  for_each_range(forest, grids, cells, medium, control,
                 [&](std::size_t first, std::size_t count, const auto& evaluate) {
                   for (std::size_t s = 0; s < axes; ++s)
                     evaluate(s, std::span(response.down).subspan(s * cells.cells + first, count),
                              std::span(response.up).subspan(s * cells.cells + first, count));
                 });
  if (!compensation.empty())
    for_each_chunk(response.down.size(), 4 * kCellsAtOnce, control, {},
                   [&](std::size_t begin, std::size_t end) {
                     const auto factor = compensation.subspan(begin, end - begin);
                     multiply(factor, std::span(response.down).subspan(begin, end - begin),
                              std::span(response.up).subspan(begin, end - begin));
                   });
  return response;
}

ScatteredCells scattered_sky_light(const SkyResponse& response, std::span<const double> sources,
                                   const RunControl& control) {
  SUNFLECK_EXPECTS(sources.size() == response.axes.size());
  ScatteredCells result = no_light(response.cells);
  for_each_chunk(response.cells, kCellsAtOnce, control, "sky", [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = 0; s < sources.size(); ++s)
      if (sources[s] != 0.0)
        add_source(response.down.data() + s * response.cells + begin,
                   response.up.data() + s * response.cells + begin, weights_of(sources[s], response.axes[s]),
                   begin, end - begin, result);
  });
  return result;
}

ScatteredCells scattered_sky_light(const Forest& forest, const ForestGrids& grids, const CellDepths& cells,
                                   const ResponseMedium& medium, std::span<const float> compensation,
                                   std::span<const double> sources, const RunControl& control) {
  SUNFLECK_EXPECTS(sources.size() == cells.directions.axes());
  ScatteredCells result = no_light(cells.cells);
  for_each_range(
      forest, grids, cells, medium, control, [&](std::size_t first, std::size_t count, const auto& evaluate) {
        std::vector<float> down(count), up(count);
        for (std::size_t s = 0; s < sources.size(); ++s) {
          if (sources[s] == 0.0 || !evaluate(s, std::span(down), std::span(up))) continue;
          if (!compensation.empty()) multiply(compensation.subspan(s * cells.cells + first, count), down, up);
          add_source(down.data(), up.data(), weights_of(sources[s], source_axis(forest, cells, medium, s)),
                     first, count, result);
        }
      });
  return result;
}

}  // namespace sunfleck
