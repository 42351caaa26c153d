// The directions of half a set as vector lanes, and the cover of a part in them.
#pragma once

#include <cmath>
#include <cstring>

#include "lighting/transport/cell_contents.h"

namespace sunfleck::transport {

// Some lanes in a register of every machine we run on; arithmetic lane by lane.
inline constexpr std::size_t kRegisterLanes = 8;
typedef float RegisterLanes __attribute__((vector_size(kRegisterLanes * sizeof(float))));
inline void load(RegisterLanes& values, const Lanes& lanes, std::size_t first) {
  std::memcpy(&values, lanes.data() + first, sizeof values);
}
inline void store(Lanes& lanes, std::size_t first, const RegisterLanes& values) {
  std::memcpy(lanes.data() + first, &values, sizeof values);
}

struct alignas(64) DirectionLanes {
  alignas(64) Lanes x{}, y{}, z{}, solid_angle_sr{};
  alignas(64) Lanes step_cells{}, per_step{};  // way from slab to slab over the edge of a cell; its inverse
};

// `step_cells` per direction.
inline DirectionLanes direction_lanes(const DirectionSet& set, const std::vector<double>& step_cells) {
  DirectionLanes lanes;
  for (std::size_t j = 0; j < set.half(); ++j) {
    lanes.x[j] = static_cast<float>(set.to_source[j].x);
    lanes.y[j] = static_cast<float>(set.to_source[j].y);
    lanes.z[j] = static_cast<float>(set.to_source[j].z);
    lanes.step_cells[j] = static_cast<float>(step_cells[j]);
    lanes.per_step[j] = static_cast<float>(1.0 / step_cells[j]);
    lanes.solid_angle_sr[j] = static_cast<float>(set.solid_angle_sr[j]);
  }
  return lanes;
}

// Sums in a fixed order that runs in vector registers.
inline float sum_of(const Lanes& a) {
  static_assert(kLanes == 16);
  float eight[8], four[4];
  for (std::size_t j = 0; j < 8; ++j) eight[j] = a[j] + a[j + 8];
  for (std::size_t j = 0; j < 4; ++j) four[j] = eight[j] + eight[j + 4];
  return (four[0] + four[2]) + (four[1] + four[3]);
}

// Cosine between normal and direction; its sign tells the face.
inline void cosines_of(const LeafPart& part, const DirectionLanes& w, Lanes& cosine) {
  for (std::size_t j = 0; j < kLanes; ++j)
    cosine[j] = part.normal.x * w.x[j] + part.normal.y * w.y[j] + part.normal.z * w.z[j];
}

// g of a flat part.
inline void depths_of(float cover, const DirectionLanes& w, const Lanes& cosine, Lanes& depth) {
  for (std::size_t j = 0; j < kLanes; ++j) {
    const float q = std::fabs(cosine[j]) * cover * w.step_cells[j];
    depth[j] = w.per_step[j] * depth_of_cover(q < kLargestPartCover ? q : kLargestPartCover);
  }
}

// g of a shoot's part, and cosines that are never negative.
inline void shoot_depths(const ShootPart& shoot, const DirectionLanes& w, Lanes& cosine, Lanes& depth) {
  cosine.fill(1.0f);
  for (std::size_t j = 0; j < kLanes; ++j) {
    const float q = shoot.cover[j] * w.step_cells[j];
    depth[j] = w.per_step[j] * depth_of_cover(q < kLargestPartCover ? q : kLargestPartCover);
  }
}

// exp(a) - 1 to second order for a the depth g of a part over half a step: radiance I of its cell without the
// part's own shade and light is I + (exp(a) - 1) (I - b), b what it sends that way itself; exact where it is
// alone in the cell. Limited to what leaves that fit a cell reach: the pieces of larger ones fill their cells
// and are no small part of them.
inline float own_part(float depth, float step_cells) {
  const float whole = 0.5f * depth * step_cells, a = whole < 0.3f ? whole : 0.3f;
  return a + 0.5f * a * a;
}

}  // namespace sunfleck::transport
