// The inner loops: runs of places against one figure, eight side by side (the vector types of
// lighting/trace/raster_lanes.h). Each calls sink.met(first, mask, nearness, a, b) for eight places of which
// at least one lies on the figure; a and b are set for plane figures. Places must be readable up to the next
// multiple of eight.
#pragma once

#include <bit>
#include <cstdint>

#include "lighting/render/raster_forms.h"
#include "lighting/trace/raster_lanes.h"

namespace sunfleck {

using trace::FloatLanes;
using trace::IntLanes;
inline constexpr std::int32_t kLanes = trace::kPixelLanes;
using WordLanes = std::uint32_t __attribute__((vector_size(4 * kLanes)));

inline bool any(const IntLanes& mask) {
  using Longs = long long __attribute__((vector_size(4 * kLanes)));
  const auto m = std::bit_cast<Longs>(mask);
  return (m[0] | m[1] | m[2] | m[3]) != 0;
}
inline FloatLanes evenly(float x) { return x - FloatLanes{}; }
inline FloatLanes larger(const FloatLanes& a, const FloatLanes& b) { return a > b ? a : b; }
inline FloatLanes smaller(const FloatLanes& a, const FloatLanes& b) { return a < b ? a : b; }
inline FloatLanes at(const LinearForm& f, const FloatLanes& x, const FloatLanes& y) {
  return f.at_corner + f.per_x * x + f.per_y * y;
}

// Per lane; plain loops that the compiler turns into one instruction.
inline FloatLanes root(const FloatLanes& x) {
  FloatLanes r;
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_sqrtf(x[i]);
  return r;
}

// Places of a run, x and y counted from the figure's corner.
struct PlaceRun {
  const float* x = nullptr;
  const float* y = nullptr;
  const std::uint32_t* number = nullptr;  // of the place's lots
  std::int32_t count = 0;
  float corner_x = 0, corner_y = 0;
};

struct SeenRange {
  float nearest = std::numeric_limits<float>::infinity();
  bool perspective = true;
  bool ahead_only = true;  // of a camera; the sun sees everything
};

template <FlatShape shape, class Sink>
void meet_flat(const FlatForms& f, const PlaceRun& run, const SeenRange& range, Sink& sink) {
  for (std::int32_t first = 0; first < run.count; first += kLanes) {
    FloatLanes x, y;
    trace::load(x, run.x + first);
    trace::load(y, run.y + first);
    x -= run.corner_x, y -= run.corner_y;
    const FloatLanes a = at(f.a, x, y), b = at(f.b, x, y), near = at(f.nearness, x, y);
    const FloatLanes most = range.perspective ? near : evenly(1.0f);
    IntLanes mask = (trace::kLaneNumbers + first < run.count) & (near <= range.nearest);
    if constexpr (shape == FlatShape::kParallelogram)
      mask &= (a <= most) & (-a <= most) & (b <= most) & (-b <= most);
    else if constexpr (shape == FlatShape::kDisc)
      mask &= (a * a + b * b <= most * most) & (most > 0.0f);
    else
      mask &= (a >= 0.0f) & (b >= 0.0f) & (a + b <= most);
    if (any(mask)) sink.met(first, mask, near, a, b);
  }
}

// A point of the line, split as in RoundForms, with the line's direction.
struct LineSplit {
  FloatLanes across, beside, along, run_across, run_beside, rise, run2;
  LineSplit(const RoundForms& f, const FloatLanes& x, const FloatLanes& y)
      : across(at(f.across, x, y)),
        beside(at(f.beside, x, y)),
        along(at(f.along, x, y)),
        run_across(at(f.run_across, x, y)),
        run_beside(at(f.run_beside, x, y)),
        rise(at(f.rise, x, y)),
        run2(run_across * run_across + run_beside * run_beside) {}
};

inline FloatLanes nearness_at(const FloatLanes& depth, const SeenRange& range) {
  return range.perspective ? 1.0f / depth : -depth;
}

// The side of a frustum, by the quadratic of lighting/trace/solids.cpp with its discriminant rearranged:
//   R^2 run^2 - (across x run)^2 - 2 R w (point . run) + w^2 |point|^2,  R radius at the point, w its change.
template <class Sink>
void meet_cone(const RoundForms& f, const PlaceRun& run, const SeenRange& range, Sink& sink) {
  const float from_m = range.ahead_only ? 0.0f : -std::numeric_limits<float>::infinity();
  for (std::int32_t first = 0; first < run.count; first += kLanes) {
    FloatLanes x, y;
    trace::load(x, run.x + first);
    trace::load(y, run.y + first);
    const LineSplit l(f, x - run.corner_x, y - run.corner_y);
    const FloatLanes radius = f.radius_m + f.taper * l.along, w = f.taper * l.rise;
    const FloatLanes aside = l.across * l.run_beside - l.beside * l.run_across;
    const FloatLanes ahead = l.across * l.run_across + l.beside * l.run_beside;
    const FloatLanes disc = radius * radius * l.run2 - aside * aside - 2.0f * radius * w * ahead +
                            w * w * (l.across * l.across + l.beside * l.beside);
    const IntLanes meets = (trace::kLaneNumbers + first < run.count) & (disc >= 0.0f);
    if (!any(meets)) continue;
    const FloatLanes b = radius * w - ahead, a = 1.0f / (l.run2 - w * w), s = root(larger(disc, evenly(0)));
    const FloatLanes one = (b - s) * a, other = (b + s) * a;
    const auto on_side = [&](const FloatLanes& t) {
      const FloatLanes h = l.along + t * l.rise;
      return (h >= 0.0f) & (h <= f.length_m) & (radius + t * w >= 0.0f) & (t + f.depth_m > from_m);
    };
    const FloatLanes t_near = smaller(one, other), t_far = larger(one, other);
    const IntLanes front = on_side(t_near), back = on_side(t_far);
    const IntLanes mask = meets & (front | back);
    if (!any(mask)) continue;
    const FloatLanes near = nearness_at(f.depth_m + (front ? t_near : t_far), range);
    sink.met(first, mask & (near <= range.nearest), near, near, near);
  }
}

// Even 32-bit lots: two rounds of multiply and shift (Wellons, "hash prospector": lowbias32).
inline WordLanes lots_of(WordLanes n, std::uint32_t key) {
  n ^= key;
  n ^= n >> 16;
  n *= 0x7feb352du;
  n ^= n >> 15;
  n *= 0x846ca68bu;
  n ^= n >> 16;
  return n;
}

// -ln(u) of u = (lot + 1/2) / 2^24 from the top 24 bits, to 2e-7: ln(1 + m) by its series in m / (2 + m).
inline FloatLanes minus_log(const WordLanes& lots) {
  const IntLanes top = std::bit_cast<IntLanes>(lots >> 8);
  const FloatLanes u = (__builtin_convertvector(top, FloatLanes) + 0.5f) * 0x1p-24f;
  const IntLanes bits = std::bit_cast<IntLanes>(u);
  const IntLanes exponent = ((bits - 0x3f3504f3) >> 23);
  const FloatLanes m = std::bit_cast<FloatLanes>(bits - (exponent << 23)) - 1.0f;
  const FloatLanes s = m / (2.0f + m), s2 = s * s;
  const FloatLanes ln = 2.0f * s * (1.0f + s2 * (1.0f / 3 + s2 * (0.2f + s2 * (1.0f / 7 + s2 * (1.0f / 9)))));
  return -(ln + 0.69314718f * __builtin_convertvector(exponent, FloatLanes));
}

// A cylinder filled with needles: a needle is met after an optical depth -ln(lot) from where the line enters.
template <class Sink>
void meet_shoot(const RoundForms& f, std::uint32_t key, const PlaceRun& run, const SeenRange& range,
                Sink& sink) {
  for (std::int32_t first = 0; first < run.count; first += kLanes) {
    FloatLanes x, y;
    trace::load(x, run.x + first);
    trace::load(y, run.y + first);
    const LineSplit l(f, x - run.corner_x, y - run.corner_y);
    const FloatLanes aside = l.across * l.run_beside - l.beside * l.run_across;
    // Along the axis there is no side to meet: inside is what lies within the radius.
    const IntLanes end_on = l.run2 <= 1e-10f * l.rise * l.rise;
    const FloatLanes run2 = end_on ? 1e-10f * l.rise * l.rise : l.run2;
    const FloatLanes disc = f.radius_m * f.radius_m * run2 - aside * aside;
    const IntLanes within = l.across * l.across + l.beside * l.beside <= f.radius_m * f.radius_m;
    const IntLanes meets = (trace::kLaneNumbers + first < run.count) & (disc > 0.0f) & (within | ~end_on);
    if (!any(meets)) continue;
    const FloatLanes ahead = l.across * l.run_across + l.beside * l.run_beside;
    const FloatLanes a = 1.0f / run2, s = root(larger(disc, evenly(0)));
    const FloatLanes by_rise = 1.0f / l.rise;
    const FloatLanes one = -l.along * by_rise, other = (f.length_m - l.along) * by_rise;
    FloatLanes enter = larger((-ahead - s) * a, smaller(one, other));
    const FloatLanes leave = smaller((s - ahead) * a, larger(one, other));
    if (range.ahead_only) enter = larger(enter, evenly(1e-6f - f.depth_m));
    WordLanes number;
    trace::load(number, run.number + first);
    const FloatLanes speed = root(l.run2 + l.rise * l.rise);
    const FloatLanes met = enter + minus_log(lots_of(number, key)) / (f.extinction_per_m * speed);
    const IntLanes mask = meets & (met < leave);
    if (any(mask)) {
      const FloatLanes near = nearness_at(f.depth_m + met, range);
      sink.met(first, mask, near, near, near);
    }
  }
}

}  // namespace sunfleck
