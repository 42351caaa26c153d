// Sky light cell by cell; see sky_light.h.
#include "lighting/slab/sky_light.h"

#include <cmath>

#include "lighting/slab/compensation.h"
#include "sim/base/parallel.h"

namespace sunfleck {

std::vector<double> sky_sources(const SampleDirections& directions, SkyModel sky, const Vec3& ground_normal) {
  std::vector<double> sources;
  double on_plane = 0.0;
  for (std::size_t j = 0; j < directions.axes(); ++j) {
    const double cos_zenith = directions.upward(j).z;
    sources.push_back(relative_sky_radiance(sky, cos_zenith));
    on_plane += sources.back() * cos_zenith;
  }
  for (std::size_t j = 0; j < directions.axes(); ++j)
    sources[j] = glm::dot(directions.upward(j), ground_normal) > 0.0 ? sources[j] / on_plane : 0.0;
  return sources;
}

std::vector<float> sky_compensation(const CellDepths& cells, const RunControl& control) {
  const SampleDirections& d = cells.directions;
  const std::size_t axes = d.axes(), count = cells.transmission.size() / axes;
  std::vector<std::vector<double>> cosines(axes);
  for (std::size_t source = 0; source < axes; ++source)
    for (std::size_t j = 0; j < d.directions(); ++j)
      cosines[source].push_back(std::clamp(glm::dot(d.direction(j), d.upward(source)), -1.0, 1.0));
  std::vector<float> result(count * axes);
  for_each_chunk(count, 64, control, "compensation", [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const std::span<const float> depths = cells.depths(cell);
      for (std::size_t s = 0; s < axes; ++s)
        result[cell * axes + s] =
            static_cast<float>(compensation(depths[s], depths[axes + s], depths, cosines[s]));
    }
  });
  return result;
}

std::vector<ScatteredLight> scattered_sky_light(const Forest& forest, const ForestGrids& grids,
                                                const CellDepths& cells,
                                                const std::vector<CanopyOptics>& optics, double ground_albedo,
                                                const std::vector<double>& sources,
                                                const std::vector<float>& compensation,
                                                const RunControl& control) {
  const std::size_t axes = cells.directions.axes();
  std::vector<ScatteredLight> result(grids.cells());
  for_each_chunk(grids.cells(), 256, control, "sky", [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const Instance& instance = forest.instances[grids.instance_of(cell)];
      const std::span<const float> depths = cells.depths(cell);
      for (std::size_t s = 0; s < axes; ++s) {
        if (sources[s] == 0.0) continue;
        const double turn = cells.turn_ratio_of(instance.prototype.value, s, instance.yaw_rad);
        const auto light = spp<double>(depths[s], depths[axes + s],
                                       optics[instance.prototype.value].medium(turn, ground_albedo));
        const double scale = sources[s] * (compensation.empty() ? 1.0 : compensation[cell * axes + s]);
        add_hemispheres(result[cell], cells.directions.upward(s), scale * light.down, scale * light.up);
      }
    }
  });
  return result;
}

}  // namespace sunfleck
