#include "lighting/shade/bough_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/shade/gauss_points.h"
#include "lighting/shade/lane_math.h"

namespace sunfleck {
namespace {

constexpr int kLanes = 8;
using Lanes = std::array<float, kLanes>;

// The constants of a direction that places need, in single precision.
struct Slopes {
  explicit Slopes(const BoughDirection& d)
      : slope(static_cast<float>(d.slope)),
        constant(static_cast<float>(d.constant)),
        one_minus_near(static_cast<float>(d.one_minus_near)),
        one_plus_far(static_cast<float>(d.one_plus_far)),
        plus_near(static_cast<float>(d.plus_near)),
        minus_near(static_cast<float>(d.minus_near)),
        plus_far(static_cast<float>(d.plus_far)),
        minus_far(static_cast<float>(d.minus_far)),
        half_sin_near(static_cast<float>(0.5 * d.sin_near)),
        half_sin_far(static_cast<float>(0.5 * d.sin_far)),
        scale(static_cast<float>(d.scale)),
        sine(static_cast<float>(d.sine)),
        across_x(static_cast<float>(d.across.x)),
        across_y(static_cast<float>(d.across.y)) {}
  float slope, constant, one_minus_near, one_plus_far, plus_near, minus_near, plus_far, minus_far;
  float half_sin_near, half_sin_far, scale, sine, across_x, across_y;
};

// LinePlace of bough_line.h, one per lane.
struct Places {
  Lanes rho, one_minus_u, one_plus_u, minus, plus;
};

inline void find_place(const Slopes& s, float offset, float t, Places& p, int i) {
  const float y2 = offset * offset;
  p.rho[i] = std::sqrt(y2 + t * t);
  const float far = 1 + std::abs(t) / p.rho[i], near = y2 / (p.rho[i] * p.rho[i] * far);
  p.one_minus_u[i] = t > 0 ? near : far;
  p.one_plus_u[i] = t > 0 ? far : near;
  p.minus[i] = std::sqrt(s.one_minus_near + s.slope * p.one_minus_u[i]);
  p.plus[i] = std::sqrt(s.one_plus_far + s.slope * p.one_plus_u[i]);
}

// depth_between of bough_line.h. beta / 2 = acos(plus / sqrt 2).
inline float lane_depth(const Slopes& s, const Places& a, const Places& b, int i) {
  const float near_a = a.minus[i] * s.plus_near + s.minus_near * a.plus[i];
  const float near_b = b.minus[i] * s.plus_near + s.minus_near * b.plus[i];
  const float far_a = s.minus_far * a.plus[i] + a.minus[i] * s.plus_far;
  const float far_b = s.minus_far * b.plus[i] + b.minus[i] * s.plus_far;
  const float near = (near_a / near_b) * (near_a / near_b) * (b.one_minus_u[i] / a.one_minus_u[i]);
  const float far = (far_a / far_b) * (far_a / far_b) * (b.one_plus_u[i] / a.one_plus_u[i]);
  // Half the angle between the two needle directions, from its sine; its cosine is never negative.
  const float sine = 0.5f * (a.minus[i] * b.plus[i] - b.minus[i] * a.plus[i]);
  const float half_turn = 1.57079633f - lane_acos(std::clamp(sine, -1.0f, 1.0f));
  const float depth =
      2 * s.slope * half_turn + s.half_sin_far * lane_log(far) - s.half_sin_near * lane_log(near);
  return std::max(0.0f, s.scale * depth);
}

// Weights of the running integral over eight points, in single precision.
struct RunningWeights {
  std::array<Lanes, kLanes> weight{};  // [j][i]: of the value at j in the integral up to i
  Lanes at{}, full{};
  RunningWeights() {
    for (std::size_t i = 0; i < kLanes; ++i) {
      at[i] = static_cast<float>(kGauss8.at[i]);
      full[i] = static_cast<float>(kGauss8.weight[i]);
      for (std::size_t j = 0; j < kLanes; ++j)
        weight[j][i] = static_cast<float>(running_weight(kGauss8, i, j));
    }
  }
};
const RunningWeights kRunning;

// Points of the stretch and what the viewer's side says of them.
struct ViewLanes {
  Places place;
  Lanes x, y, z;  // position
  Lanes rate;     // depth per share of the stretch (in q)
  Lanes depth;    // from the viewer
};

ViewLanes view_lanes(const BoughVolume& v, const Vec3& origin, const BoughDirection& ray, const Slopes& s,
                     const BoughSpans::Span& span, float depth_before) {
  const double offset =
      std::max(std::abs(origin.x * ray.across.y - origin.y * ray.across.x), 1e-6 * v.outer_radius);
  const double start = origin.x * ray.across.x + origin.y * ray.across.y;
  const double q_from = std::asinh((start + span.from * ray.sine) / offset);
  const float q0 = static_cast<float>(q_from), y0 = static_cast<float>(offset);
  const float q_way = static_cast<float>(std::asinh((start + span.to * ray.sine) / offset) - q_from);
  // Foot of the perpendicular from the axis: positions are counted from there.
  const Vec3 foot = origin - start / ray.sine * ray.along;
  const float fx = static_cast<float>(foot.x), fy = static_cast<float>(foot.y),
              fz = static_cast<float>(foot.z);
  const float dz = static_cast<float>(ray.along.z / ray.sine);
  ViewLanes view;
  for (int i = 0; i < kLanes; ++i) {
    const float e = lane_exp(q0 + kRunning.at[i] * q_way);
    const float t = 0.5f * y0 * (e - 1 / e);
    find_place(s, y0, t, view.place, i);
    view.rate[i] = s.scale * view.place.minus[i] * view.place.plus[i] * q_way;
    view.x[i] = fx + t * s.across_x;
    view.y[i] = fy + t * s.across_y;
    view.z[i] = fz + t * dz;
    view.depth[i] = depth_before;
  }
  for (int j = 0; j < kLanes; ++j)
    for (int i = 0; i < kLanes; ++i) view.depth[i] += kRunning.weight[j][i] * view.rate[j];
  for (int i = 0; i < kLanes; ++i) view.depth[i] = std::max(0.0f, view.depth[i]);
  return view;
}

// The way to the light from each point: closest approach, the end of the way as t, and a gap in it (empty
// where from = to) that lies beyond the last whorl.
struct LightLanes {
  Lanes offset, start, to, gap_from, gap_to;
  float free_way(int i) const { return std::min(to[i], gap_from[i]) - start[i]; }
};

LightLanes light_lanes(const BoughVolume& v, const Slopes& s, const ViewLanes& view) {
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
void end_at_whorls(const BoughVolume& v, const BoughDirection& d, const ViewLanes& view, LightLanes& light) {
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

Lanes depths(const Slopes& s, const Lanes& offset, const Lanes& from, const Lanes& to) {
  Places a, b;
  Lanes depth;
  for (int i = 0; i < kLanes; ++i) {
    find_place(s, offset[i], from[i], a, i);
    find_place(s, offset[i], to[i], b, i);
  }
  for (int i = 0; i < kLanes; ++i) depth[i] = lane_depth(s, a, b, i);
  return depth;
}

Lanes light_depths(const BoughVolume& v, const Slopes& s, const LightLanes& light) {
  Lanes depth = depths(s, light.offset, light.start, light.to);
  if (!std::isfinite(v.lowest)) return depth;
  const Lanes gap = depths(s, light.offset, light.gap_from, light.gap_to);
  for (int i = 0; i < kLanes; ++i) depth[i] = std::max(0.0f, depth[i] - gap[i]);
  return depth;
}

// sqrt(sigma_V sigma_L) at t on the way to the light.
inline float joint_extinction(const BoughVolume& v, const Slopes& ray, const Slopes& sun, float x, float y,
                              float t_from_point, float offset, float t, Places& scratch, int i) {
  find_place(sun, offset, t, scratch, i);
  const float there_x = x + t_from_point * sun.across_x, there_y = y + t_from_point * sun.across_y;
  const float radial = (there_x * ray.across_x + there_y * ray.across_y) / scratch.rho[i];
  const float cosine = ray.constant + ray.slope * std::clamp(radial, -1.0f, 1.0f);
  const float sine_view = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return static_cast<float>(v.density) * std::sqrt(sine_view * scratch.minus[i] * scratch.plus[i]) /
         scratch.rho[i];
}

// The hot spot's shared depth by three points of equal weight under the exponential.
Lanes shared_depths(const BoughVolume& v, const Slopes& ray, const Slopes& sun, float decorrelation,
                    const ViewLanes& view, const LightLanes& light) {
  constexpr std::array<float, 3> at{0.1127016653792583f, 0.5f, 0.8872983346207417f};
  constexpr std::array<float, 3> weight{5.0f / 18, 8.0f / 18, 5.0f / 18};
  Lanes shared{};
  Places scratch;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < kLanes; ++i) {
      const float way = std::max(light.free_way(i), 1e-20f) / sun.sine;
      const float falls = std::max(decorrelation * way, 1e-3f);  // below that the exponential is flat
      const float mass = 1 - lane_exp(-falls);
      const float u = -lane_log(1 - at[k] * mass) / falls * way;
      const float t = u * sun.sine;
      shared[i] += weight[k] * mass / falls * way *
                   joint_extinction(v, ray, sun, view.x[i], view.y[i], t, light.offset[i], light.start[i] + t,
                                    scratch, i);
    }
  return shared;
}

// rate * Rd at every point, before shadow.
Lanes unshaded(const Slopes& sun, float cos_between, const ViewLanes& view) {
  Lanes light;
  for (int i = 0; i < kLanes; ++i) {
    const float radial = (view.x[i] * sun.across_x + view.y[i] * sun.across_y) / view.place.rho[i];
    const float cos_light = sun.constant + sun.slope * std::clamp(radial, -1.0f, 1.0f);
    const float sin_light = std::sqrt(std::max(0.0f, 1 - cos_light * cos_light));
    const float minus = view.place.minus[i], plus = view.place.plus[i];
    const float cos_view = 0.5f * (plus * plus - minus * minus);
    const float product = std::max(minus * plus * sin_light, 1e-12f);
    const float c = std::clamp((cos_between + cos_view * cos_light) / product, -1.0f, 1.0f);
    const float bracket = lane_acos(-c) * c + std::sqrt(1 - c * c);
    light[i] = view.rate[i] * 0.25f * sin_light * std::max(0.0f, bracket);
  }
  return light;
}

}  // namespace

float stretch_light(const BoughVolume& v, const Vec3& origin, const BoughDirection& ray,
                    const BoughDirection& to_light, const BoughSpans::Span& span, float& depth) {
  const Slopes view_slopes(ray), sun(to_light);
  const ViewLanes view = view_lanes(v, origin, ray, view_slopes, span, depth);
  const Lanes light = unshaded(sun, static_cast<float>(-glm::dot(ray.along, to_light.along)), view);
  LightLanes way = light_lanes(v, sun, view);
  if (std::isfinite(v.lowest)) end_at_whorls(v, to_light, view, way);
  const Lanes to_sun = light_depths(v, sun, way);
  Lanes shared{};
  if (v.hot_spot_length > 0) {
    const double apart = glm::length(ray.along + to_light.along);
    shared = shared_depths(v, view_slopes, sun, static_cast<float>(apart / v.hot_spot_length), view, way);
  }
  Lanes part;
  for (int i = 0; i < kLanes; ++i) {
    const float both = std::max(view.depth[i] + to_sun[i] - shared[i], std::max(view.depth[i], to_sun[i]));
    part[i] = kRunning.full[i] * light[i] * lane_exp(-both);
  }
  float reflected = 0;
  for (int i = 0; i < kLanes; ++i) {
    reflected += part[i];
    depth += kRunning.full[i] * view.rate[i];
  }
  return reflected;
}

}  // namespace sunfleck
