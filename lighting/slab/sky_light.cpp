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

void multiply(std::span<const float> factor, std::size_t begin, std::size_t end, SkyResponse& response) {
  for (std::size_t i = begin; i < end; ++i) {
    response.down[i] *= factor[i];
    response.up[i] *= factor[i];
  }
}

void scale(float factor, std::size_t begin, std::size_t end, SkyResponse& response) {
  for (std::size_t i = begin; i < end; ++i) {
    response.down[i] *= factor;
    response.up[i] *= factor;
  }
}

void spp_response(const Forest& forest, const ForestGrids& grids, const CellDepths& cells,
                  const ResponseMedium& medium, const RunControl& control, SkyResponse& response) {
  const SampleDirections& d = cells.directions;
  const std::vector<SppRowMedium> media = row_media(cells, medium);
  for_each_chunk(forest.instances.size(), 4, control, "sky", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Instance& instance = forest.instances[i];
      const std::size_t first = grids.first_cell[i], count = grids.first_cell[i + 1] - first;
      const int step = d.step_of(instance.yaw_rad);
      for (std::size_t s = 0; s < d.axes(); ++s)
        spp_row(cells.depths(s).subspan(first, count), cells.depths(d.axes() + s).subspan(first, count),
                media[instance.prototype.value * d.keys() + d.key(s, step)],
                std::span(response.down).subspan(s * cells.cells + first, count),
                std::span(response.up).subspan(s * cells.cells + first, count));
    }
  });
}

void spp_h_response(const Forest& forest, const CellDepths& cells, const ResponseMedium& medium,
                    const RunControl& control, SkyResponse& response) {
  const SampleDirections& d = cells.directions;
  const CanopyOptics mean = forest_optics(forest, medium.optics);
  const Vec3 normal = forest.terrain.normal();
  for_each_chunk(cells.cells, kCellsAtOnce, control, "sky", [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = 0; s < d.axes(); ++s) {
      const double cosine = glm::dot(d.upward(s), normal);
      if (!(cosine > 0.0)) continue;  // no sky behind the slope
      spp_h_row(cells.depths(s).subspan(begin, end - begin),
                cells.depths(d.axes() + s).subspan(begin, end - begin),
                medium.angles->medium(cosine, mean.absorption, mean.turn, medium.ground_albedo),
                std::span(response.down).subspan(s * cells.cells + begin, end - begin),
                std::span(response.up).subspan(s * cells.cells + begin, end - begin));
      scale(static_cast<float>(medium.angles->fluence_scale(cosine)), s * cells.cells + begin,
            s * cells.cells + end, response);
    }
  });
}

// Adds `weight` (down + up) to sum and `drift` (down - up) to the three others; all spans are of one size.
struct SourceWeights {
  float sum, x, y, z;
};
void add_source(const float* __restrict down, const float* __restrict up, const SourceWeights& w,
                std::size_t begin, std::size_t end, ScatteredCells& to) {
  float *__restrict sum = to.sum.data(), *__restrict x = to.drift_x.data(), *__restrict y = to.drift_y.data(),
                    *__restrict z = to.drift_z.data();
  for (std::size_t i = begin; i < end; ++i) {
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
  SUNFLECK_EXPECTS(medium.optics.size() == forest.prototypes.size());
  const std::size_t axes = cells.directions.axes();
  SkyResponse response{
      cells.cells, {}, std::vector<float>(axes * cells.cells), std::vector<float>(axes * cells.cells)};
  for (std::size_t s = 0; s < axes; ++s)
    response.axes.push_back(medium.angles ? forest.terrain.normal() : cells.directions.upward(s));
  if (medium.angles)
    spp_h_response(forest, cells, medium, control, response);
  else
    spp_response(forest, grids, cells, medium, control, response);
  if (!compensation.empty())
    for_each_chunk(response.down.size(), 4 * kCellsAtOnce, control, {},
                   [&](std::size_t begin, std::size_t end) { multiply(compensation, begin, end, response); });
  return response;
}

ScatteredCells scattered_sky_light(const SkyResponse& response, std::span<const double> sources,
                                   const RunControl& control) {
  SUNFLECK_EXPECTS(sources.size() == response.axes.size());
  ScatteredCells result;
  for (std::vector<float>* v : {&result.sum, &result.drift_x, &result.drift_y, &result.drift_z})
    v->resize(response.cells);
  for_each_chunk(response.cells, kCellsAtOnce, control, "sky", [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = 0; s < sources.size(); ++s) {
      if (sources[s] == 0.0) continue;
      const Vec3 drift = sources[s] * response.axes[s];
      add_source(response.down.data() + s * response.cells, response.up.data() + s * response.cells,
                 {static_cast<float>(sources[s]), static_cast<float>(drift.x), static_cast<float>(drift.y),
                  static_cast<float>(drift.z)},
                 begin, end, result);
    }
  });
  return result;
}

}  // namespace sunfleck
