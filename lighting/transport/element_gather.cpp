// See element_gather.h.
#include "lighting/transport/element_gather.h"

#include <algorithm>
#include <cmath>

#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

struct Corners {
  std::array<std::size_t, 8> cell{};
  std::array<float, 8> weight{};
  std::size_t own_cell = 0;
  float own_weight = 0;
};

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

// Radiance of a cell: from the directions of the half set, and from their opposites.
struct alignas(64) CellRadiance {
  alignas(64) Lanes near{}, far{};
};

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

class PartGather {
 public:
  PartGather(const TransportScene& scene, const std::vector<CellRadiance>& radiance,
             std::span<const FacePair> given)
      : scene_(scene), radiance_(radiance), given_(given), lanes_(scene.lanes) {}

  FacePair light_of(std::size_t index, const Corners& corners) const {
    const LeafPart& part = scene_.contents.parts[index];
    const ShootPart* shoot = part.shoot > 0 ? &scene_.contents.shoots[part.shoot - 1] : nullptr;
    const FacePair given = given_.empty() ? FacePair{} : given_[index];
    alignas(64) Lanes cosine, depth, cover, weight, front, back;
    if (shoot != nullptr) {
      shoot_depths(*shoot, lanes_, cosine, depth);
      cover = shoot->cover;
    } else {
      cosines_of(part, lanes_, cosine);
      depths_of(part.cover, lanes_, cosine, depth);
      for (std::size_t j = 0; j < kLanes; ++j) cover[j] = std::fabs(cosine[j]);
    }
    // What reaches the front travels as what the part sends off its back.
    const float sent_front = given.front / static_cast<float>(kPi),
                sent_back = given.back / static_cast<float>(kPi);
    for (std::size_t j = 0; j < kLanes; ++j)
      depth[j] = corners.own_weight * own_part(depth[j], lanes_.step_cells[j]);
    const CellRadiance& own_cell = radiance_[corners.own_cell];
    for (std::size_t first = 0; first < kLanes; first += kRegisterLanes) {
      RegisterLanes near, far, cos, own, covered, solid_angle, own_near, own_far;
      mean_of(corners, first, near, far);
      load(own, depth, first);
      load(cos, cosine, first);
      load(covered, cover, first);
      load(solid_angle, lanes_.solid_angle_sr, first);
      load(own_near, own_cell.near, first);
      load(own_far, own_cell.far, first);
      const RegisterLanes nothing = {}, off_front = nothing + sent_front, off_back = nothing + sent_back;
      near += own * (own_near - (cos >= nothing ? off_back : off_front));
      far += own * (own_far - (cos >= nothing ? off_front : off_back));
      near = near > nothing ? near : nothing;
      far = far > nothing ? far : nothing;
      const RegisterLanes weights = solid_angle * covered;
      store(weight, first, weights);
      store(front, first, weights * (cos >= nothing ? near : far));
      store(back, first, weights * (cos >= nothing ? far : near));
    }
    const float per_radiance = static_cast<float>(kPi) / sum_of(weight);
    const float on_front = per_radiance * sum_of(front), on_back = per_radiance * sum_of(back);
    if (shoot == nullptr) return {on_front, on_back};
    const float even = shoot->escape * 0.5f * (on_front + on_back);
    return {even, even};
  }

 private:
  void mean_of(const Corners& corners, std::size_t first, RegisterLanes& near, RegisterLanes& far) const {
    near = far = RegisterLanes{};
    RegisterLanes of_corner;
    for (std::size_t k = 0; k < 8; ++k) {
      const CellRadiance& corner = radiance_[corners.cell[k]];
      load(of_corner, corner.near, first);
      near += corners.weight[k] * of_corner;
      load(of_corner, corner.far, first);
      far += corners.weight[k] * of_corner;
    }
  }

  const TransportScene& scene_;
  const std::vector<CellRadiance>& radiance_;
  const std::span<const FacePair> given_;
  const DirectionLanes& lanes_;
};

std::vector<FacePair> light_of_parts(const TransportScene& scene, std::span<const float> radiance,
                                     std::span<const FacePair> given, const RunControl& control) {
  const CellContents& contents = scene.contents;
  const std::vector<CellRadiance> of_cells = by_cell(scene, radiance, control);
  const PartGather parts(scene, of_cells, given);
  std::vector<FacePair> light(contents.parts.size());
  for_each_chunk(contents.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    for (std::uint32_t cell = contents.ranges[r].begin; cell < contents.ranges[r].end; ++cell) {
      for (std::uint32_t p = contents.first_part[cell]; p < contents.first_part[cell + 1]; ++p) {
        const std::uint32_t e = contents.parts[p].element;
        const bool whole = contents.first_part_of_element[e + 1] - contents.first_part_of_element[e] == 1;
        const Corners corners =
            whole ? corners_around(scene.layout, cell, Vec3(scene.field->elements()[e].centre_m))
                  : only_cell(cell);
        light[p] = parts.light_of(p, corners);
      }
    }
  });
  return light;
}

}  // namespace

std::vector<FacePair> gather(const TransportScene& scene, std::span<const float> radiance,
                             std::span<const FacePair> given, const RunControl& control) {
  const CellContents& contents = scene.contents;
  const std::vector<FacePair> of_parts = light_of_parts(scene, radiance, given, control);
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
