// See element_gather.h.
#include "lighting/transport/element_gather.h"

#include <algorithm>
#include <cmath>

#include "lighting/transport/gather_kernel.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

// Two neighbours along an axis: what they add to the flat index, and their weights.
struct Between {
  std::array<std::size_t, 2> offset;
  std::array<float, 2> weight;
};

Between between_centres(const GridLayout& layout, int axis, double coordinate_m, std::size_t stride) {
  const int n = layout.cells[static_cast<std::size_t>(axis)];
  const double at = (coordinate_m - layout.lo_m[axis]) / layout.cell_m[axis] - 0.5;
  const double floor = std::floor(at);
  const int low = static_cast<int>(std::clamp(floor, -1.0, static_cast<double>(n)));
  const bool wraps = layout.wraps_xy && axis < 2;
  const auto inside = [&](int i) {
    return static_cast<std::size_t>(wraps ? (i + n) % n : std::clamp(i, 0, n - 1)) * stride;
  };
  const auto part = static_cast<float>(std::clamp(at - floor, 0.0, 1.0));
  return {{inside(low), inside(low + 1)}, {1.0f - part, part}};
}

Corners corners_around(const GridLayout& layout, std::uint32_t own_cell, const Vec3& point_m) {
  const auto row = static_cast<std::size_t>(layout.cells[0]);
  const Between x = between_centres(layout, 0, point_m.x, 1), y = between_centres(layout, 1, point_m.y, row),
                z = between_centres(layout, 2, point_m.z, row * static_cast<std::size_t>(layout.cells[1]));
  Corners corners;
  corners.own_cell = own_cell;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::size_t i = k & 1, j = k >> 1 & 1, l = k >> 2;
    corners.cell[k] = x.offset[i] + y.offset[j] + z.offset[l];
    corners.weight[k] = x.weight[i] * y.weight[j] * z.weight[l];
    if (corners.cell[k] == own_cell) corners.own_weight += corners.weight[k];
  }
  return corners;
}

Corners only_cell(std::uint32_t cell) {
  Corners corners;
  corners.cell.fill(cell);
  corners.weight[0] = 1.0f;
  corners.own_cell = cell;
  corners.own_weight = 1.0f;
  return corners;
}

std::vector<CellRadiance> by_cell(const TransportScene& scene, std::span<const float> radiance,
                                  const RunControl& control) {
  const std::size_t cells = scene.cells(), half = scene.set.half();
  std::vector<CellRadiance> all(cells);
  for_each_chunk(cells, 8192, control, {}, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kBlock = 16;  // cells: one line of memory in every direction
    for (std::size_t b = begin; b < end; b += kBlock)
      for (std::size_t j = 0; j < half; ++j)
        for (std::size_t c = b; c < std::min(end, b + kBlock); ++c) {
          all[c].near[j] = radiance[j * cells + c];
          all[c].far[j] = radiance[(half + j) * cells + c];
        }
  });
  return all;
}

// One or two kinds of light; `given` is in the last.
struct Lights {
  std::array<std::vector<CellRadiance>, 2> radiance;  // the second empty where there is but one
  std::span<const FacePair> given;

  std::size_t count() const { return radiance[1].empty() ? 1 : 2; }
};

// [kind][part]
using PartLights = std::array<std::vector<FacePair>, 2>;

PartLights light_of_parts(const TransportScene& scene, const Lights& lights, const RunControl& control) {
  const CellContents& contents = scene.contents;
  const GatherPart gather_part = gather_part_best();
  PartLights light;
  for (std::size_t i = 0; i < lights.count(); ++i) light[i].resize(contents.parts.size());
  for_each_chunk(contents.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    for (std::uint32_t cell = contents.ranges[r].begin; cell < contents.ranges[r].end; ++cell) {
      for (std::uint32_t p = contents.first_part[cell]; p < contents.first_part[cell + 1]; ++p) {
        const LeafPart& part = contents.parts[p];
        const std::uint32_t e = part.element;
        const bool whole = contents.first_part_of_element[e + 1] - contents.first_part_of_element[e] == 1;
        const Corners corners =
            whole ? corners_around(scene.layout, cell, Vec3(scene.field->elements()[e].centre_m))
                  : only_cell(cell);
        PartInLight in_light{.part = part,
                             .shoot = shoot_of(part, contents.shoots.data()),
                             .corners = corners,
                             .radiance = {lights.radiance[0].data(), nullptr},
                             .given = {}};
        if (lights.count() == 2) in_light.radiance[1] = lights.radiance[1].data();
        if (!lights.given.empty()) in_light.given[lights.count() - 1] = lights.given[p];
        std::array<FacePair, 2> found;
        gather_part(in_light, scene.lanes, found.data());
        for (std::size_t i = 0; i < lights.count(); ++i) light[i][p] = found[i];
      }
    }
  });
  return light;
}

std::vector<FacePair> light_of_elements(const TransportScene& scene, const std::vector<FacePair>& of_parts,
                                        const RunControl& control) {
  const CellContents& contents = scene.contents;
  std::vector<FacePair> light(scene.field->elements().size());
  for_each_chunk(light.size(), 8192, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      for (std::uint32_t i = contents.first_part_of_element[e]; i < contents.first_part_of_element[e + 1];
           ++i) {
        const std::uint32_t p = contents.parts_of_element[i];
        light[e].front += contents.parts[p].share * of_parts[p].front;
        light[e].back += contents.parts[p].share * of_parts[p].back;
      }
    }
  });
  return light;
}

}  // namespace

std::vector<FacePair> gather(const TransportScene& scene, std::span<const float> radiance,
                             std::span<const FacePair> given, const RunControl& control) {
  const Lights lights{.radiance = {by_cell(scene, radiance, control), {}}, .given = given};
  return light_of_elements(scene, light_of_parts(scene, lights, control)[0], control);
}

GatheredPair gather_two(const TransportScene& scene, std::span<const float> first,
                        std::span<const float> second, std::span<const FacePair> given_second,
                        const RunControl& control) {
  const Lights lights{.radiance = {by_cell(scene, first, control), by_cell(scene, second, control)},
                      .given = given_second};
  const PartLights of_parts = light_of_parts(scene, lights, control);
  return {light_of_elements(scene, of_parts[0], control), light_of_elements(scene, of_parts[1], control)};
}

void add_light_inside_shoot(const CellContents& contents, std::size_t e, const std::vector<LeafBand>& leaf,
                            ElementLight& light) {
  if (contents.first_part_of_element[e] == contents.first_part_of_element[e + 1]) return;
  const LeafPart& part = contents.parts[contents.parts_of_element[contents.first_part_of_element[e]]];
  const float gain = shoot_gain(leaf[part.optics].albedo, contents.shoots[part.shoot - 1].escape) - 1.0f;
  const float inside = gain * 0.5f * (light.front.total() + light.back.total());
  light.front.scattered_w_m2 += inside;
  light.back.scattered_w_m2 += inside;
}

}  // namespace sunfleck::transport
