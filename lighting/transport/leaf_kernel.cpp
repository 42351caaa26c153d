// See leaf_kernel.h.
#include "lighting/transport/leaf_kernel.h"

#include "lighting/transport/wide_lanes.h"

namespace sunfleck::transport {

namespace {

constexpr float kPiF = static_cast<float>(kPi), kPerPi = static_cast<float>(1.0 / kPi);

// From the light that the radiance brings to a part to what the part gives back, W m-2.
struct PartLight {
  FacePair light, given;
};
[[gnu::always_inline]] inline PartLight light_of_part(const LeafOrder& order, const LeafPart& part,
                                                      float front, float back) {
  const ShootPart* shoot = shoot_of(part, order.shoots);
  FacePair light{front, back};
  if (shoot != nullptr) light.front = light.back = shoot->escape * 0.5f * (front + back);
  if (order.direct != nullptr) {
    light.front += order.beam_w_m2 * order.direct[part.element].front;
    light.back += order.beam_w_m2 * order.direct[part.element].back;
  }
  if (shoot != nullptr) {
    const float gain = shoot_gain(order.bands[part.optics].albedo, shoot->escape);
    light = {gain * light.front, gain * light.back};
  }
  return {light, radiosity_of(order.bands[part.optics], shoot != nullptr, light)};
}

[[gnu::always_inline]] inline double keep(const LeafOrder& order, std::uint32_t p, const PartLight& part) {
  order.last[p] = part.light;
  order.total[p].front += part.light.front;
  order.total[p].back += part.light.back;
  return static_cast<double>(order.parts[p].cover) * (part.given.front + part.given.back);
}

// Light on the faces from the radiance of a cell. `sent`: what the part gave back the order before.
FacePair face_light(const CellLight& cell, const DirectionLanes& lanes, const Lanes& cosine,
                    const Lanes& depth, float scale, const FacePair& sent) {
  // What reaches the front travels as what the part sends off its back.
  const float sent_front = sent.front / kPiF, sent_back = sent.back / kPiF;
  Lanes weight, front, back;
  for (std::size_t j = 0; j < kLanes; ++j) {
    const bool on_front = cosine[j] >= 0.0f;
    const float own = own_part(depth[j], lanes.step_cells[j]);
    const float to_front = on_front ? cell.near[j] : cell.far[j];
    const float to_back = on_front ? cell.far[j] : cell.near[j];
    weight[j] = lanes.solid_angle_sr[j] * depth[j];
    front[j] = weight[j] * std::max(0.0f, to_front + own * (to_front - sent_back));
    back[j] = weight[j] * std::max(0.0f, to_back + own * (to_back - sent_front));
  }
  const float per_radiance = scale * kPiF / sum_of(weight);
  return {per_radiance * sum_of(front), per_radiance * sum_of(back)};
}

// Registers of a cell while its leaves pass.
struct WideCell {
  WideLanes near, far, source_near, source_far, depth;
  WideLanes x, y, z, solid_angle_sr, step_cells, per_step;
};

[[gnu::always_inline]] inline void load_cell(WideCell& wide, const CellLight& cell,
                                             const DirectionLanes& lanes) {
  load_wide(wide.near, cell.near);
  load_wide(wide.far, cell.far);
  load_wide(wide.source_near, cell.source_near);
  load_wide(wide.source_far, cell.source_far);
  load_wide(wide.depth, cell.depth);
  load_wide(wide.x, lanes.x);
  load_wide(wide.y, lanes.y);
  load_wide(wide.z, lanes.z);
  load_wide(wide.solid_angle_sr, lanes.solid_angle_sr);
  load_wide(wide.step_cells, lanes.step_cells);
  load_wide(wide.per_step, lanes.per_step);
}

[[gnu::always_inline]] inline void store_sources(const WideCell& wide, CellLight& cell) {
  store_wide(cell.source_near, wide.source_near);
  store_wide(cell.source_far, wide.source_far);
  store_wide(cell.depth, wide.depth);
}

// -ln(1 - q) of a part's cover over a step, and its cosines.
[[gnu::always_inline]] inline void step_depth(const LeafOrder& order, const LeafPart& part,
                                              const WideCell& wide, WideLanes& cosine, WideLanes& depth) {
  WideLanes q;
  if (part.shoot > 0) {
    cosine = WideLanes{} + 1.0f;
    load_wide(q, order.shoots[part.shoot - 1].cover);
    q *= wide.step_cells;
  } else {
    cosine = part.normal.x * wide.x + part.normal.y * wide.y + part.normal.z * wide.z;
    q = part.cover * cosine * wide.step_cells;
    absolute_wide(q);
  }
  const WideLanes largest = WideLanes{} + kLargestPartCover;
  q = q < largest ? q : largest;
  depth = 3.0f * q * (2.0f - q) / (6.0f + q * (q - 6.0f));
}

// Light arriving from w travels along -w: off the back where w is on the front's side.
[[gnu::always_inline]] inline void add_sources(WideCell& wide, const WideMask& from_behind,
                                               const WideLanes& depth, const FacePair& given) {
  const WideLanes nothing = {}, off_front = nothing + given.front * kPerPi,
                  off_back = nothing + given.back * kPerPi;
  WideLanes off_near, off_far;
  choose_wide(off_near, from_behind, off_front, off_back);
  choose_wide(off_far, from_behind, off_back, off_front);
  wide.source_near += depth * off_near;
  wide.source_far += depth * off_far;
  wide.depth += depth;
}

[[gnu::always_inline]] inline double scatter_leaf(const LeafOrder& order, std::uint32_t p, WideCell& wide) {
  const LeafPart& part = order.parts[p];
  const FacePair sent = radiosity_of(order.bands[part.optics], part.shoot > 0, order.last[p]);
  const float sent_front = sent.front * kPerPi, sent_back = sent.back * kPerPi;
  const WideLanes nothing = {};
  WideLanes cosine, depth;
  step_depth(order, part, wide, cosine, depth);
  const WideLanes whole = 0.5f * depth, most = nothing + 0.3f, a = whole < most ? whole : most,
                  own = a + 0.5f * a * a;
  depth *= wide.per_step;
  const WideLanes weight = wide.solid_angle_sr * depth;
  WideMask from_behind;
  negative_lanes(from_behind, cosine);
  WideLanes to_front, to_back;
  choose_wide(to_front, from_behind, wide.far, wide.near);
  choose_wide(to_back, from_behind, wide.near, wide.far);
  WideLanes front = to_front + own * (to_front - sent_back), back = to_back + own * (to_back - sent_front);
  front = weight * (front > nothing ? front : nothing);
  back = weight * (back > nothing ? back : nothing);
  float sums[3];
  sums_wide(weight, front, back, sums);
  const float per_radiance = order.scale * kPiF / sums[0];
  const PartLight done = light_of_part(order, part, per_radiance * sums[1], per_radiance * sums[2]);
  add_sources(wide, from_behind, depth, done.given);
  return keep(order, p, done);
}

[[gnu::always_inline]] inline void emit_leaf(const LeafOrder& order, std::uint32_t p, const FacePair& given,
                                             WideCell& wide) {
  WideLanes cosine, depth;
  step_depth(order, order.parts[p], wide, cosine, depth);
  depth *= wide.per_step;
  WideMask from_behind;
  negative_lanes(from_behind, cosine);
  add_sources(wide, from_behind, depth, given);
}

[[gnu::always_inline]] inline double scatter_leaves(const LeafOrder& order, const DirectionLanes& lanes,
                                                    std::uint32_t begin, std::uint32_t end, CellLight& cell) {
  WideCell wide;
  load_cell(wide, cell, lanes);
  double power = 0.0;
  for (std::uint32_t p = begin; p < end; ++p) power += scatter_leaf(order, p, wide);
  store_sources(wide, cell);
  return power;
}

[[gnu::always_inline]] inline void emit_leaves(const LeafOrder& order, const DirectionLanes& lanes,
                                               const FacePair* given, std::uint32_t begin, std::uint32_t end,
                                               CellLight& cell) {
  WideCell wide;
  load_cell(wide, cell, lanes);
  for (std::uint32_t p = begin; p < end; ++p) emit_leaf(order, p, given[p], wide);
  store_sources(wide, cell);
}

void emit_leaves_v3(const LeafOrder& order, const DirectionLanes& lanes, const FacePair* given,
                    std::uint32_t begin, std::uint32_t end, CellLight& cell) {
  emit_leaves(order, lanes, given, begin, end, cell);
}

[[gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]] void emit_leaves_avx512(
    const LeafOrder& order, const DirectionLanes& lanes, const FacePair* given, std::uint32_t begin,
    std::uint32_t end, CellLight& cell) {
  emit_leaves(order, lanes, given, begin, end, cell);
}

double scatter_leaves_v3(const LeafOrder& order, const DirectionLanes& lanes, std::uint32_t begin,
                         std::uint32_t end, CellLight& cell) {
  return scatter_leaves(order, lanes, begin, end, cell);
}

[[gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]] double scatter_leaves_avx512(
    const LeafOrder& order, const DirectionLanes& lanes, std::uint32_t begin, std::uint32_t end,
    CellLight& cell) {
  return scatter_leaves(order, lanes, begin, end, cell);
}

}  // namespace

void deposit(CellLight& cell, const Lanes& cosine, const Lanes& depth, const FacePair& radiosity) {
  const float front = radiosity.front / kPiF, back = radiosity.back / kPiF;
  for (std::size_t j = 0; j < kLanes; ++j) {
    const bool on_front = cosine[j] >= 0.0f;
    cell.source_near[j] += depth[j] * (on_front ? back : front);
    cell.source_far[j] += depth[j] * (on_front ? front : back);
    cell.depth[j] += depth[j];
  }
}

double scatter_leaves_plain(const LeafOrder& order, const DirectionLanes& lanes, std::uint32_t begin,
                            std::uint32_t end, CellLight& cell) {
  double power = 0.0;
  for (std::uint32_t p = begin; p < end; ++p) {
    const LeafPart& part = order.parts[p];
    Lanes cosine, depth;
    part_depths(part, shoot_of(part, order.shoots), lanes, cosine, depth);
    const FacePair sent = radiosity_of(order.bands[part.optics], part.shoot > 0, order.last[p]);
    const FacePair faces = face_light(cell, lanes, cosine, depth, order.scale, sent);
    const PartLight done = light_of_part(order, part, faces.front, faces.back);
    deposit(cell, cosine, depth, done.given);
    power += keep(order, p, done);
  }
  return power;
}

void emit_leaves_plain(const LeafOrder& order, const DirectionLanes& lanes, const FacePair* given,
                       std::uint32_t begin, std::uint32_t end, CellLight& cell) {
  for (std::uint32_t p = begin; p < end; ++p) {
    Lanes cosine, depth;
    part_depths(order.parts[p], shoot_of(order.parts[p], order.shoots), lanes, cosine, depth);
    deposit(cell, cosine, depth, given[p]);
  }
}

namespace {

bool is_wide_machine() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
}

}  // namespace

ScatterLeaves scatter_leaves_best() { return is_wide_machine() ? scatter_leaves_avx512 : scatter_leaves_v3; }
EmitLeaves emit_leaves_best() { return is_wide_machine() ? emit_leaves_avx512 : emit_leaves_v3; }

}  // namespace sunfleck::transport
