// See direct_sun.h.
#include "lighting/transport/direct_sun.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

// Small chunks: level rays go around a periodic scene many times.
constexpr std::size_t kPointsPerChunk = 16;

void light_ground(DirectSun& sun, const GroundMap& ground, const ExtinctionGrid& grid,
                  const RunControl& control) {
  for_each_chunk(ground.count(), kPointsPerChunk, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
      sun.ground[g] = static_cast<float>(
          sun.open_ground * std::exp(-grid.depth_from_point(ground.world_point(g), March::kForward)));
  });
}

void light_wood(DirectSun& sun, const TransportScene& scene, const ExtinctionGrid& grid, const Vec3& to_sun,
                const RunControl& control) {
  const GridLayout& layout = scene.layout;
  const std::vector<float> depths = wood_depths(scene.contents, *scene.field, to_sun);
  for_each_chunk(sun.wood.size(), kPointsPerChunk, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const auto cell = layout.unflat(scene.contents.wood[w].cell);
      const Vec3 centre = layout.lo_m + (Vec3(cell[0], cell[1], cell[2]) + 0.5) * layout.cell_m;
      sun.wood[w] = depths[w] * static_cast<float>(std::exp(-grid.depth_from_point(
                                    scene.ground->world_from_field(centre), March::kForward)));
    }
  });
}

// `seen(index, element)`: share of the element that the sun reaches.
template <class Seen>
void light_seen(DirectSun& sun, const BlockerField& field, const Vec3& to_sun, const RunControl& control,
                const Seen& seen) {
  sun.elements.assign(field.elements().size(), {});
  sun.sunlit_fraction.assign(field.elements().size(), 0.0f);
  for_each_chunk(field.elements().size(), 4096, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const FieldElement& e = field.elements()[i];
      if (e.below_ground) continue;
      const double lit = seen(i, e);
      const double cosine = e.is_shoot() ? 0.0 : glm::dot(Vec3(e.axis), to_sun);
      const double even = e.is_shoot() ? 0.25 : 0.0;  // mean over needles that face everywhere
      sun.sunlit_fraction[i] = static_cast<float>(lit);
      sun.elements[i] = {static_cast<float>(lit * (even + std::max(0.0, cosine))),
                         static_cast<float>(lit * (even + std::max(0.0, -cosine)))};
    }
  });
}

// What the elements of a period leave of its sun goes to ground and wood.
void close_budget(DirectSun& sun, const TransportScene& scene) {
  const double cell_m2 = scene.ground->cell_area_m2();
  double left_w = sun.open_ground * cell_m2 * static_cast<double>(sun.ground.size());
  for (std::size_t i = 0; i < sun.elements.size(); ++i)
    left_w -= static_cast<double>(scene.field->elements()[i].area_m2) *
              (static_cast<double>(sun.elements[i].front) + sun.elements[i].back);
  double taken_w = 0.0;
  for (const float e : sun.ground) taken_w += cell_m2 * e;
  for (const float w : sun.wood) taken_w += std::pow(scene.layout.mean_cell_m(), 2) * w;
  if (!(taken_w > 0.0)) return;
  const auto factor = static_cast<float>(std::max(0.0, left_w) / taken_w);
  for (float& e : sun.ground) e *= factor;
  for (float& w : sun.wood) w *= factor;
}

}  // namespace

std::vector<float> sun_depths(const CellContents& contents, const BlockerField& field,
                              const ExtinctionGrid& grid, const RunControl& control) {
  std::vector<float> depths(field.elements().size(), static_cast<float>(kLargestDepth));
  const std::size_t chunk = field.layout().wraps_xy ? kPointsPerChunk : 512;
  for_each_chunk(contents.parts.size(), chunk, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::uint32_t e = contents.parts[p].element;
      if (contents.parts_of_element[contents.first_part_of_element[e]] == p)
        depths[e] = static_cast<float>(grid.depth_from_element(e, March::kForward));
    }
  });
  return depths;
}

void light_elements(DirectSun& sun, const BlockerField& field, std::span<const float> depths,
                    const Vec3& to_sun, const RunControl& control) {
  light_seen(sun, field, to_sun, control, [&](std::size_t i, const FieldElement& e) {
    return std::exp(-static_cast<double>(depths[i])) * own_transmittance(e, to_sun);
  });
}

void light_elements_as_known(DirectSun& sun, const BlockerField& field,
                             std::span<const float> sunlit_fraction, const Vec3& to_sun,
                             const RunControl& control) {
  SUNFLECK_EXPECTS(sunlit_fraction.size() == field.elements().size());
  light_seen(sun, field, to_sun, control,
             [&](std::size_t i, const FieldElement&) { return static_cast<double>(sunlit_fraction[i]); });
}

DirectSun direct_sun(const TransportScene& scene, const Forest& forest, const Vec3& to_sun,
                     std::span<const float> sunlit_fraction, const RunControl& control) {
  const BlockerField& field = *scene.field;
  DirectSun sun;
  sun.elements.resize(field.elements().size());
  sun.sunlit_fraction.resize(field.elements().size());
  sun.ground.resize(scene.ground->count());
  sun.wood.resize(scene.contents.wood.size());
  if (field.ends_on_ground(to_sun)) return sun;
  sun.open_ground = glm::dot(to_sun, forest.terrain.normal());
  const ExtinctionGrid grid(field, to_sun, control);
  if (sunlit_fraction.empty())
    light_elements(sun, field, sun_depths(scene.contents, field, grid, control), to_sun, control);
  else
    light_elements_as_known(sun, field, sunlit_fraction, to_sun, control);
  light_ground(sun, *scene.ground, grid, control);
  light_wood(sun, scene, grid, to_sun, control);
  if (scene.periodic && !sunlit_fraction.empty()) close_budget(sun, scene);
  return sun;
}

}  // namespace sunfleck::transport
