// The ways from eight places of a bough to the light: where they end, where they leave a finite bough for a
// while, and the depth along them. Private to the folder.
#pragma once

#include "lighting/shade/bough_places.h"

namespace sunfleck {

// The way to the light from each point: closest approach, the end of the way as t, and a gap in it (empty
// where from = to) that lies beyond the last whorl.
struct LightLanes {
  Lanes offset, start, to, gap_from, gap_to;
  float free_way(int i) const { return std::min(to[i], gap_from[i]) - start[i]; }
};

inline LightLanes light_lanes(const BoughVolume& v, const Slopes& s, const ViewLanes& view) {
  LightLanes light;
  const float outer = static_cast<float>(v.outer_radius), least = 1e-6f * outer;
  for (int i = 0; i < kLanes; ++i) {
    light.offset[i] = std::max(std::abs(view.x[i] * s.across_y - view.y[i] * s.across_x), least);
    light.start[i] = view.x[i] * s.across_x + view.y[i] * s.across_y;
    const float half2 = outer * outer - light.offset[i] * light.offset[i];
    light.to[i] = std::max(light.start[i], std::sqrt(std::max(half2, 0.0f)));
    light.gap_from[i] = light.gap_to[i] = light.to[i];
  }
  return light;
}

// Roots of A s^2 + 2 B s + C that say where a way meets the cone z - rho cot(aperture) = height, both nappes.
struct ConeRoots {
  float low, high;
  bool real;
};

inline ConeRoots cone_roots(float a, float b, float c) {
  const float discriminant = b * b - a * c;
  const float far = -(b + std::copysign(std::sqrt(std::max(discriminant, 0.0f)), b));
  const float one = far / a, other = c / (far == 0 ? 1e-30f : far);
  return {std::min(one, other), std::max(one, other), discriminant >= 0};
}

// A finite bough ends the way at its first whorl, and has a gap beyond its last one. z - rho cot(aperture) is
// concave along a line: once below the first whorl a way never comes back, and the gap is one stretch.
inline void end_at_whorls(const BoughVolume& v, const BoughDirection& d, const ViewLanes& view,
                          LightLanes& light) {
  constexpr float never = 1e30f;
  const float sin2 = static_cast<float>(v.sin_aperture * v.sin_aperture), cos2 = 1 - sin2;
  const float dx = static_cast<float>(d.along.x), dy = static_cast<float>(d.along.y);
  const float dz = static_cast<float>(d.along.z), sine = static_cast<float>(d.sine);
  const float steep = cos2 * sine * sine - sin2 * dz * dz;
  const float a = std::abs(steep) < 1e-7f ? std::copysign(1e-7f, steep) : steep;
  const float lowest = static_cast<float>(v.lowest), highest = static_cast<float>(v.highest);
  for (int i = 0; i < kLanes; ++i) {
    const float across = cos2 * (view.x[i] * dx + view.y[i] * dy);
    const float rho2 = cos2 * (view.x[i] * view.x[i] + view.y[i] * view.y[i]);
    const float z0 = view.z[i] - lowest, z1 = view.z[i] - highest;
    const ConeRoots first = cone_roots(a, across - sin2 * z0 * dz, rho2 - sin2 * z0 * z0);
    const float leaves = !first.real      ? never
                         : first.low > 0  ? first.low
                         : first.high > 0 ? first.high
                                          : never;
    const ConeRoots last = cone_roots(a, across - sin2 * z1 * dz, rho2 - sin2 * z1 * z1);
    // Shallow ways cross one nappe twice, the upper one if they are high there; steep ones each nappe once.
    const bool upper = z1 + 0.5f * (last.low + last.high) * dz > 0;
    const bool crosses = last.real && last.high > 0 && (a > 0 ? upper : dz > 0);
    const float gap_from = !crosses ? never : a > 0 ? std::max(last.low, 0.0f) : last.high;
    const float gap_to = !crosses ? never : a > 0 ? last.high : never;
    light.to[i] = std::min(light.to[i], light.start[i] + leaves * sine);
    light.gap_from[i] = std::min(light.to[i], light.start[i] + gap_from * sine);
    light.gap_to[i] = std::min(light.to[i], light.start[i] + gap_to * sine);
  }
}

inline Lanes depths(const Slopes& s, const Lanes& offset, const Lanes& from, const Lanes& to) {
  Places a, b;
  Lanes depth;
  for (int i = 0; i < kLanes; ++i) {
    find_place(s, offset[i], from[i], a, i);
    find_place(s, offset[i], to[i], b, i);
  }
  for (int i = 0; i < kLanes; ++i) depth[i] = lane_depth(s, a, b, i);
  return depth;
}

inline Lanes light_depths(const BoughVolume& v, const Slopes& s, const LightLanes& light) {
  Lanes depth = depths(s, light.offset, light.start, light.to);
  if (!std::isfinite(v.lowest)) return depth;
  const Lanes gap = depths(s, light.offset, light.gap_from, light.gap_to);
  for (int i = 0; i < kLanes; ++i) depth[i] = std::max(0.0f, depth[i] - gap[i]);
  return depth;
}

}  // namespace sunfleck
