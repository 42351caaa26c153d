// See envelope_depths.h.
#include "lighting/envelope/envelope_depths.h"

#include "lighting/depth/extinction_grid.h"
#include "lighting/envelope/closed_forms.h"
#include "sim/base/parallel.h"

namespace sunfleck::envelope {

MarchedSectors march_sectors(const BlockerField& field, const RunControl& control) {
  MarchedSectors result{.depths = SectorDepths(field.elements().size())};
  const auto store = [&](std::size_t sector, const std::vector<float>& depth) {
    for (std::size_t i = 0; i < depth.size(); ++i) result.depths[i][sector] = depth[i];
  };
  // Opposite directions see the same projected areas: one grid for j and 7 - j.
  ExtinctionGrid grid(field, cube_directions<double>()[0], control);
  for (std::size_t j = 0; j < 4; ++j) {
    if (j > 0) grid.turn_to(cube_directions<double>()[j], control);
    store(j, grid.depth_of_elements(March::kForward, control));
    store(7 - j, grid.depth_of_elements(March::kBackward, control));
    result.clamped += grid.clamped();
  }
  return result;
}

namespace {

std::vector<float> interpolated_sun_depths(const SectorDepths& sectors, const Vec3& to_sun,
                                           const RunControl& control) {
  std::array<double, 8> weights;
  interpolation_weights<double>(cube_directions<double>(), to_sun, weights);
  std::vector<float> depths(sectors.size());
  for_each_chunk(depths.size(), 16384, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double depth = 0.0;
      for (std::size_t j = 0; j < 8; ++j) depth += weights[j] * sectors[i][j];  // Eq. 7, in depths
      depths[i] = static_cast<float>(depth);
    }
  });
  return depths;
}

}  // namespace

std::vector<float> sun_depths(const BlockerField& field, const SectorDepths& sectors, const Vec3& to_sun,
                              EnvelopeSun method, const RunControl& control) {
  if (field.ends_on_ground(to_sun))
    return std::vector<float>(sectors.size(), static_cast<float>(kLargestDepth));
  if (method == EnvelopeSun::kPublished) return interpolated_sun_depths(sectors, to_sun, control);
  return ExtinctionGrid(field, to_sun, control).depth_of_elements(March::kForward, control);
}

}  // namespace sunfleck::envelope
