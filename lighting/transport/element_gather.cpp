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

struct Between {
  int low, high;
  double part;  // of the higher
};

Between between_centres(const GridLayout& layout, int axis, double coordinate_m) {
  const int n = layout.cells[static_cast<std::size_t>(axis)];
  const double at = (coordinate_m - layout.lo_m[axis]) / layout.cell_m[axis] - 0.5;
  const double floor = std::floor(at);
  const int low = static_cast<int>(std::clamp(floor, -1.0, static_cast<double>(n)));
  const auto inside = [&](int i) {
    return layout.wraps_xy && axis < 2 ? (i + n) % n : std::clamp(i, 0, n - 1);
  };
  return {inside(low), inside(low + 1), std::clamp(at - floor, 0.0, 1.0)};
}

Corners corners_around(const GridLayout& layout, std::uint32_t own_cell, const Vec3& point_m) {
  const Between x = between_centres(layout, 0, point_m.x), y = between_centres(layout, 1, point_m.y),
                z = between_centres(layout, 2, point_m.z);
  Corners corners;
  corners.own_cell = own_cell;
  for (std::size_t k = 0; k < 8; ++k) {
    const bool hx = k & 1, hy = k & 2, hz = k & 4;
    corners.cell[k] = layout.flat({hx ? x.high : x.low, hy ? y.high : y.low, hz ? z.high : z.low});
    corners.weight[k] = static_cast<float>((hx ? x.part : 1 - x.part) * (hy ? y.part : 1 - y.part) *
                                           (hz ? z.part : 1 - z.part));
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

class PartGather {
 public:
  PartGather(const TransportScene& scene, std::span<const float> radiance, std::span<const FacePair> given)
      : scene_(scene), radiance_(radiance.data()), given_(given), lanes_(scene.lanes) {}

  FacePair light_of(std::size_t index, const Corners& corners) const {
    const LeafPart& part = scene_.contents.parts[index];
    const ShootPart* shoot = part.shoot > 0 ? &scene_.contents.shoots[part.shoot - 1] : nullptr;
    const FacePair given = given_.empty() ? FacePair{} : given_[index];
    Lanes cosine, depth;
    if (shoot != nullptr) {
      shoot_depths(*shoot, lanes_, cosine, depth);
    } else {
      cosines_of(part, lanes_, cosine);
      depths_of(part.cover, lanes_, cosine, depth);
    }
    float front = 0.0f, back = 0.0f, norm = 0.0f;
    for (std::size_t j = 0; j < scene_.set.half(); ++j) {
      const bool on_front = cosine[j] >= 0.0f;
      const float own = corners.own_weight * own_part(depth[j], lanes_.step_cells[j]);
      const float near = radiance_at(j, corners, own, on_front ? given.back : given.front);
      const float far = radiance_at(scene_.set.half() + j, corners, own, on_front ? given.front : given.back);
      const float weight =
          lanes_.solid_angle_sr[j] * (shoot != nullptr ? shoot->cover[j] : std::abs(cosine[j]));
      front += weight * (on_front ? near : far);
      back += weight * (on_front ? far : near);
      norm += weight;
    }
    const float per_radiance = static_cast<float>(kPi) / norm;
    if (shoot == nullptr) return {per_radiance * front, per_radiance * back};
    const float even = shoot->escape * per_radiance * 0.5f * (front + back);
    return {even, even};
  }

 private:
  float radiance_at(std::size_t direction, const Corners& corners, float own, float own_radiosity) const {
    const float* radiance = radiance_ + direction * scene_.cells();
    float sum = 0.0f;
    for (std::size_t k = 0; k < 8; ++k) sum += corners.weight[k] * radiance[corners.cell[k]];
    const float own_radiance = own_radiosity * static_cast<float>(1.0 / kPi);
    return std::max(0.0f, sum + own * (radiance[corners.own_cell] - own_radiance));
  }

  const TransportScene& scene_;
  const float* radiance_;
  const std::span<const FacePair> given_;
  const DirectionLanes& lanes_;
};

std::vector<FacePair> light_of_parts(const TransportScene& scene, std::span<const float> radiance,
                                     std::span<const FacePair> given, const RunControl& control) {
  const CellContents& contents = scene.contents;
  const PartGather parts(scene, radiance, given);
  std::vector<FacePair> light(contents.parts.size());
  for_each_chunk(contents.ranges.size(), 1, control, {}, [&](std::size_t r, std::size_t) {
    for (std::uint32_t cell = contents.ranges[r].begin; cell < contents.ranges[r].end; ++cell) {
      for (std::uint32_t p = contents.first_part[cell]; p < contents.first_part[cell + 1]; ++p) {
        const std::uint32_t e = contents.parts[p].element;
        const bool whole = contents.first_part_of_element[e + 1] - contents.first_part_of_element[e] == 1;
        const Corners corners =
            whole ? corners_around(scene.field->layout(), cell, Vec3(scene.field->elements()[e].centre_m))
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
