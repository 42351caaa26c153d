// One ray through one bough in single precision and without calls: where it enters and leaves, and its
// optical depth. The quick twin of bough_spans and bough_depth (bough.h has the formulas and their limits),
// for rays that meet many boughs; within 2e-3 of them in exp(-depth) (tested). About 40 ns.
//
// The inside of a finite bough along a ray: h(s) = z - rho cot(aperture) is concave, so h >= lowest is one
// stretch, and h >= highest a stretch that is taken out of it.
#pragma once

#include <algorithm>
#include <cmath>

#include "lighting/shade/bough.h"
#include "lighting/shade/lane_math.h"

namespace sunfleck {

struct QuickBough {
  float sine = 0, cosine = 1;  // of the aperture
  float outer_radius = 0, density = 0, lowest = 0, highest = 0;
};
inline QuickBough quick_bough(const BoughVolume& v) {
  return {static_cast<float>(v.sin_aperture), static_cast<float>(v.cos_aperture),
          static_cast<float>(v.outer_radius), static_cast<float>(v.density),
          static_cast<float>(v.lowest),       static_cast<float>(v.highest)};
}

struct QuickCrossing {
  float enter = 0, leave = 0, depth = 0;  // distances along the ray; depth 0: nothing met
};

namespace quick {

struct Stretch {
  float from, to;
  bool empty() const { return !(from < to); }
};

// Where the line is above the whorl at `height`; foot.z of the point of closest approach, s from there.
inline Stretch above_whorl(const QuickBough& b, float offset, float sine, float dz, float z) {
  constexpr float kNever = 1e30f;
  const float sin2 = b.sine * b.sine, cos2 = b.cosine * b.cosine;
  const float steep = cos2 * sine * sine - sin2 * dz * dz;
  const float a = std::abs(steep) < 1e-9f ? -1e-9f : steep;
  const float half_b = -sin2 * z * dz, c = cos2 * offset * offset - sin2 * z * z;
  const float discriminant = half_b * half_b - a * c;
  if (a > 0 && (discriminant <= 0 || z - half_b / a * dz <= 0)) return {kNever, -kNever};
  const float q = -(half_b + std::copysign(std::sqrt(std::max(discriminant, 0.0f)), half_b));
  const float one = q / a, other = q != 0 ? c / q : one;
  const float low = std::min(one, other), high = std::max(one, other);
  if (a > 0) return {low, high};
  return dz > 0 ? Stretch{high, kNever} : Stretch{-kNever, low};
}

struct Way {
  float slope, one_minus_near, one_plus_far, plus_near, minus_near, plus_far, minus_far;
  float scale, sine, offset;
};

inline Way way_of(const QuickBough& b, float sine, float dz, float offset) {
  Way w;
  const float ds = sine - b.sine, near = dz - b.cosine, far = dz + b.cosine;
  w.slope = b.sine * sine;
  w.one_minus_near = 0.5f * (near * near + ds * ds);
  w.one_plus_far = 0.5f * (far * far + ds * ds);
  w.minus_near = std::sqrt(w.one_minus_near);
  w.plus_near = std::sqrt(std::max(0.0f, 2 - w.one_minus_near));
  w.plus_far = std::sqrt(w.one_plus_far);
  w.minus_far = std::sqrt(std::max(0.0f, 2 - w.one_plus_far));
  w.scale = b.density / sine;
  w.sine = sine;
  w.offset = offset;
  return w;
}

struct Place {
  float one_minus_u, one_plus_u, minus, plus;
};

inline Place place_at(const Way& w, float s) {
  const float t = s * w.sine, y2 = w.offset * w.offset, rho2 = y2 + t * t, rho = std::sqrt(rho2);
  const float far = 1 + std::abs(t) / rho, near = y2 / (rho2 * far);
  Place p;
  p.one_minus_u = t > 0 ? near : far;
  p.one_plus_u = t > 0 ? far : near;
  p.minus = std::sqrt(w.one_minus_near + w.slope * p.one_minus_u);
  p.plus = std::sqrt(w.one_plus_far + w.slope * p.one_plus_u);
  return p;
}

// depth_between of bough_line.h.
inline float depth_over(const Way& w, const Stretch& s) {
  const Place a = place_at(w, s.from), b = place_at(w, s.to);
  const float near_a = a.minus * w.plus_near + w.minus_near * a.plus;
  const float near_b = b.minus * w.plus_near + w.minus_near * b.plus;
  const float far_a = w.minus_far * a.plus + a.minus * w.plus_far;
  const float far_b = w.minus_far * b.plus + b.minus * w.plus_far;
  const float near = (near_a / near_b) * (near_a / near_b) * (b.one_minus_u / a.one_minus_u);
  const float far = (far_a / far_b) * (far_a / far_b) * (b.one_plus_u / a.one_plus_u);
  const float sine = 0.5f * (a.minus * b.plus - b.minus * a.plus);
  const float half_turn = 1.57079633f - lane_acos(std::clamp(sine, -1.0f, 1.0f));
  const float depth = 2 * w.slope * half_turn + 0.5f * (w.minus_far * w.plus_far * lane_log(far) -
                                                        w.minus_near * w.plus_near * lane_log(near));
  return std::max(0.0f, w.scale * depth);
}

}  // namespace quick

// Of the ray from `origin` in `direction` (unit; the bough's frame), between the distances near and far.
inline QuickCrossing quick_crossing(const QuickBough& b, const Vec3f& origin, const Vec3f& direction,
                                    float near, float far) {
  constexpr float kLeast = static_cast<float>(kLeastSine);
  const float across = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  const bool bent = across < kLeast;  // towards x, as bough_direction does it
  const float sine = bent ? kLeast : across;
  const float ax = bent ? (across > 0 ? direction.x / across : 1.0f) : direction.x / across;
  const float ay = bent ? (across > 0 ? direction.y / across : 0.0f) : direction.y / across;
  const float signed_offset = origin.x * ay - origin.y * ax;
  const float half2 = b.outer_radius * b.outer_radius - signed_offset * signed_offset;
  if (!(half2 > 0)) return {};
  const float before = (origin.x * ax + origin.y * ay) / sine;  // distances are counted from closest approach
  const float half = std::sqrt(half2) / sine;
  quick::Stretch in{std::max(-half, near + before), std::min(half, far + before)};
  if (in.empty()) return {};
  const float dz = bent ? std::copysign(std::sqrt(1 - kLeast * kLeast), direction.z) : direction.z;
  const float offset = std::max(std::abs(signed_offset), 1e-6f * b.outer_radius), z = origin.z - before * dz;
  const quick::Stretch first = quick::above_whorl(b, offset, sine, dz, z - b.lowest);
  in = {std::max(in.from, first.from), std::min(in.to, first.to)};
  if (in.empty()) return {};
  const quick::Stretch last = quick::above_whorl(b, offset, sine, dz, z - b.highest);
  const quick::Stretch gap{std::max(in.from, last.from), std::min(in.to, last.to)};
  const quick::Way way = quick::way_of(b, sine, dz, offset);
  if (gap.empty()) return {in.from - before, in.to - before, quick::depth_over(way, in)};
  // A gap at an end is left out; one in the middle is taken off.
  if (gap.from <= in.from && gap.to >= in.to) return {};
  if (gap.from <= in.from)
    in.from = gap.to;
  else if (gap.to >= in.to)
    in.to = gap.from;
  else
    return {in.from - before, in.to - before,
            quick::depth_over(way, {in.from, gap.from}) + quick::depth_over(way, {gap.to, in.to})};
  return {in.from - before, in.to - before, quick::depth_over(way, in)};
}

}  // namespace sunfleck
