// Eight places of a ray inside a bough side by side, in single precision: the twins of LinePlace and
// depth_between of bough_line.h, written so that loops over lanes become vector code. Private to the folder.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/shade/bough.h"
#include "lighting/shade/lane_math.h"

namespace sunfleck {

inline constexpr int kLanes = 8;
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

// Points of the stretch and what the viewer's side says of them.
struct ViewLanes {
  Places place;
  Lanes x, y, z;  // position
  Lanes rate;     // depth per share of the stretch (in q)
  Lanes depth;    // from the viewer
};

}  // namespace sunfleck
