// See gather_kernel.h.
#include "lighting/transport/gather_kernel.h"

#include "lighting/transport/leaf_kernel.h"
#include "lighting/transport/wide_lanes.h"

namespace sunfleck::transport {

namespace {

constexpr float kPiF = static_cast<float>(kPi), kPerPi = static_cast<float>(1.0 / kPi);

// Cosines, covers and the part of the own shade that the weight of the own cell lets through.
struct WidePart {
  WideLanes cosine, cover, own;
};

[[gnu::always_inline]] inline void measure(const PartInLight& p, const DirectionLanes& lanes,
                                           WidePart& wide) {
  WideLanes x, y, z, step;
  load_wide(x, lanes.x);
  load_wide(y, lanes.y);
  load_wide(z, lanes.z);
  load_wide(step, lanes.step_cells);
  const WideLanes nothing = {};
  WideLanes q;
  if (p.shoot != nullptr) {
    wide.cosine = nothing + 1.0f;
    load_wide(wide.cover, p.shoot->cover);
    q = wide.cover * step;
  } else {
    wide.cosine = p.part.normal.x * x + p.part.normal.y * y + p.part.normal.z * z;
    wide.cover = wide.cosine;
    absolute_wide(wide.cover);
    q = p.part.cover * wide.cover * step;
  }
  const WideLanes largest = nothing + kLargestPartCover, most = nothing + 0.3f;
  q = q < largest ? q : largest;
  const WideLanes whole = 0.5f * (3.0f * q * (2.0f - q) / (6.0f + q * (q - 6.0f)));
  const WideLanes a = whole < most ? whole : most;
  wide.own = p.corners.own_weight * (a + 0.5f * a * a);
}

[[gnu::always_inline]] inline FacePair light_on(const PartInLight& p, const WidePart& wide,
                                                const WideLanes& solid_angle_sr, const CellRadiance* radiance,
                                                const FacePair& given) {
  WideLanes near = {}, far = {}, of_corner;
  for (std::size_t k = 0; k < 8; ++k) {
    load_wide(of_corner, radiance[p.corners.cell[k]].near);
    near += p.corners.weight[k] * of_corner;
    load_wide(of_corner, radiance[p.corners.cell[k]].far);
    far += p.corners.weight[k] * of_corner;
  }
  WideLanes own_near, own_far;
  load_wide(own_near, radiance[p.corners.own_cell].near);
  load_wide(own_far, radiance[p.corners.own_cell].far);
  // What reaches the front travels as what the part sends off its back.
  const WideLanes nothing = {}, off_front = nothing + given.front * kPerPi,
                  off_back = nothing + given.back * kPerPi;
  WideMask from_behind;
  negative_lanes(from_behind, wide.cosine);
  WideLanes off_near, off_far, to_front, to_back;
  choose_wide(off_near, from_behind, off_front, off_back);
  choose_wide(off_far, from_behind, off_back, off_front);
  near += wide.own * (own_near - off_near);
  far += wide.own * (own_far - off_far);
  near = near > nothing ? near : nothing;
  far = far > nothing ? far : nothing;
  choose_wide(to_front, from_behind, far, near);
  choose_wide(to_back, from_behind, near, far);
  const WideLanes weight = solid_angle_sr * wide.cover, front = weight * to_front, back = weight * to_back;
  float sums[3];
  sums_wide(weight, front, back, sums);
  const float per_radiance = kPiF / sums[0];
  const FacePair light{per_radiance * sums[1], per_radiance * sums[2]};
  if (p.shoot == nullptr) return light;
  const float even = p.shoot->escape * 0.5f * (light.front + light.back);
  return {even, even};
}

[[gnu::always_inline]] inline void gather_part(const PartInLight& p, const DirectionLanes& lanes,
                                               FacePair* light) {
  WidePart wide;
  measure(p, lanes, wide);
  WideLanes solid_angle_sr;
  load_wide(solid_angle_sr, lanes.solid_angle_sr);
  light[0] = light_on(p, wide, solid_angle_sr, p.radiance[0], p.given[0]);
  if (p.radiance[1] != nullptr) light[1] = light_on(p, wide, solid_angle_sr, p.radiance[1], p.given[1]);
}

void gather_part_v3(const PartInLight& part, const DirectionLanes& lanes, FacePair* light) {
  gather_part(part, lanes, light);
}

[[gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]] void gather_part_avx512(
    const PartInLight& part, const DirectionLanes& lanes, FacePair* light) {
  gather_part(part, lanes, light);
}

FacePair plain_light_on(const PartInLight& p, const DirectionLanes& lanes, const CellRadiance* radiance,
                        const FacePair& given) {
  alignas(64) Lanes cosine, depth;
  part_depths(p.part, p.shoot, lanes, cosine, depth);
  float weights = 0.0f, front = 0.0f, back = 0.0f;
  for (std::size_t j = 0; j < kLanes; ++j) {
    float near = 0.0f, far = 0.0f;
    for (std::size_t k = 0; k < 8; ++k) {
      near += p.corners.weight[k] * radiance[p.corners.cell[k]].near[j];
      far += p.corners.weight[k] * radiance[p.corners.cell[k]].far[j];
    }
    const bool on_front = cosine[j] >= 0.0f;
    const float own = p.corners.own_weight * own_part(depth[j], lanes.step_cells[j]);
    const CellRadiance& here = radiance[p.corners.own_cell];
    near += own * (here.near[j] - (on_front ? given.back : given.front) / kPiF);
    far += own * (here.far[j] - (on_front ? given.front : given.back) / kPiF);
    const float cover = p.shoot != nullptr ? p.shoot->cover[j] : std::fabs(cosine[j]);
    const float weight = lanes.solid_angle_sr[j] * cover;
    weights += weight;
    front += weight * std::max(0.0f, on_front ? near : far);
    back += weight * std::max(0.0f, on_front ? far : near);
  }
  front *= kPiF / weights;
  back *= kPiF / weights;
  if (p.shoot == nullptr) return {front, back};
  const float even = p.shoot->escape * 0.5f * (front + back);
  return {even, even};
}

}  // namespace

void gather_part_plain(const PartInLight& p, const DirectionLanes& lanes, FacePair* light) {
  for (std::size_t i = 0; i < 2; ++i)
    if (p.radiance[i] != nullptr) light[i] = plain_light_on(p, lanes, p.radiance[i], p.given[i]);
}

GatherPart gather_part_best() {
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  return wide ? gather_part_avx512 : gather_part_v3;
}

}  // namespace sunfleck::transport
