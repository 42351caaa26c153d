// See direct_sun.h.
#include "lighting/transport/direct_sun.h"

#include <algorithm>
#include <cmath>

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
  sun.elements.assign(field.elements().size(), {});
  sun.sunlit_fraction.assign(field.elements().size(), 0.0f);
  for_each_chunk(depths.size(), 4096, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const FieldElement& e = field.elements()[i];
      if (e.below_ground) continue;
      const double seen = std::exp(-static_cast<double>(depths[i])) * own_transmittance(e, to_sun);
      const double cosine = e.is_shoot() ? 0.0 : glm::dot(Vec3(e.axis), to_sun);
      const double even = e.is_shoot() ? 0.25 : 0.0;  // mean over needles that face everywhere
      sun.sunlit_fraction[i] = static_cast<float>(seen);
      sun.elements[i] = {static_cast<float>(seen * (even + std::max(0.0, cosine))),
                         static_cast<float>(seen * (even + std::max(0.0, -cosine)))};
    }
  });
}

DirectSun direct_sun(const TransportScene& scene, const Forest& forest, const Vec3& to_sun,
                     const RunControl& control) {
  const BlockerField& field = *scene.field;
  DirectSun sun;
  sun.elements.resize(field.elements().size());
  sun.sunlit_fraction.resize(field.elements().size());
  sun.ground.resize(scene.ground->count());
  sun.wood.resize(scene.contents.wood.size());
  if (field.ends_on_ground(to_sun)) return sun;
  sun.open_ground = glm::dot(to_sun, forest.terrain.normal());
  const ExtinctionGrid grid(field, to_sun, control);
  light_elements(sun, field, sun_depths(scene.contents, field, grid, control), to_sun, control);
  light_ground(sun, *scene.ground, grid, control);
  light_wood(sun, scene, grid, to_sun, control);
  return sun;
}

}  // namespace sunfleck::transport
