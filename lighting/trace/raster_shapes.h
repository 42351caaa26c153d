// What a picture of the sun is drawn from: leaves, discs and triangles as flat figures, wood and shoots as
// solids, all in pixel coordinates (raster_view.h), and the runs of pixels whose centres they cover.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "lighting/trace/raster_view.h"

namespace sunfleck::trace {

// Half-open ranges of pixels.
struct PixelBox {
  std::int32_t u_lo = 0, v_lo = 0, u_hi = 0, v_hi = 0;
  bool empty() const { return u_lo >= u_hi || v_lo >= v_hi; }
};
inline PixelBox common(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.u_lo, b.u_lo), std::max(a.v_lo, b.v_lo), std::min(a.u_hi, b.u_hi),
          std::min(a.v_hi, b.v_hi)};
}

inline constexpr std::uint32_t kOnlyShades = 0xFFFFFFFFu;  // wood

enum class Figure : std::uint8_t { kParallelogram, kDisc, kTriangle, kCone, kShoot };

struct RasterRecord {
  double u = 0, v = 0;         // of the centre; of a cone's base
  float s = 0, s_a = 0, s_b = 0;  // depth there, and along half_u and half_v of a flat figure
  float a_du = 0, a_dv = 0, b_du = 0, b_dv = 0;  // half_u and half_v of a flat figure in pixels
  PixelBox bounds;  // every pixel whose square the figure touches
  std::uint32_t element = kOnlyShades;
  std::uint32_t solid = 0;  // of a cone or shoot
  Figure figure = Figure::kParallelogram;
  bool small = false;  // may lie between the centres of all pixels
};

// A frustum's side or a cylinder, cut by lines along to_sun: t metres along the line from the plane through
// the base or centre, as polynomials of the pixels (du, dv) from there.
struct RasterSolid {
  double height_u = 0, height_v = 0, rise = 0;           // along the axis: per pixel, per metre of t
  double across_uu = 0, across_uv = 0, across_vv = 0;    // |vector from the axis|^2
  double run_u = 0, run_v = 0, run2 = 0;                 // its product with the way aside, and that squared
  double aside_u = 0, aside_v = 0;                       // distance from the plane of axis and sun
  double lowest = 0, highest = 0, radius = 0, taper = 0;  // heights; radius at height 0
  double widest = 0;
  float extinction_per_m = 0;  // of a shoot
};

// The shares a of half_u and b of half_v that lead to a point of a flat figure, per pixel from its centre.
struct FlatShares {
  double a_u = 0, a_v = 0, b_u = 0, b_v = 0;
  bool edge_on = true;  // seen along its plane: covers nothing
};
inline FlatShares shares_of(const RasterRecord& r) {
  const double au = r.a_du, av = r.a_dv, bu = r.b_du, bv = r.b_dv;
  const double det = au * bv - av * bu, longest2 = std::max(au * au + av * av, bu * bu + bv * bv);
  if (!(std::abs(det) > 1e-6 * longest2)) return {};
  return {bv / det, -bu / det, -av / det, au / det, false};
}

struct RasterScene {
  std::vector<RasterRecord> records;
  std::vector<RasterSolid> solids;
};

// The line through a pixel that lies (du, dv) from a solid's base or centre.
class SolidLine {
 public:
  SolidLine(const RasterSolid& solid, double du, double dv)
      : solid_(solid), height_(du * solid.height_u + dv * solid.height_v) {
    const double r = solid.radius + solid.taper * height_, widening = solid.taper * solid.rise;
    a_ = solid.run2 - widening * widening;
    b_ = du * solid.run_u + dv * solid.run_v - r * widening;
    c_ = du * (du * solid.across_uu + 2.0 * dv * solid.across_uv) + dv * dv * solid.across_vv - r * r;
  }
  // Where the line meets the frustum's side nearest to the sun.
  std::optional<double> nearest() const;
  // The part of the line inside the cylinder.
  struct Chord {
    double enter, leave;  // leave is nearer to the sun
  };
  std::optional<Chord> chord() const;

 private:
  bool on_side(double t) const {
    const double h = height_ + t * solid_.rise;
    return h >= solid_.lowest && h <= solid_.highest && solid_.radius + solid_.taper * h >= 0.0;
  }
  std::optional<Chord> roots() const;

  const RasterSolid& solid_;
  double height_, a_, b_, c_;
};

// The pixels of row v whose centres a band lo <= p (u - u0) + q <= hi holds.
struct Run {
  double lo, hi;  // of u - u0, real
  void cut(double p, double q, double least, double most) {
    constexpr double kTiny = 1e-30;
    const double inverse = 1.0 / (std::abs(p) > kTiny ? p : kTiny);
    const double x = (least - q) * inverse, y = (most - q) * inverse;
    lo = std::max(lo, std::min(x, y));
    hi = std::min(hi, std::max(x, y));
  }
};

// Calls visit(v, u_begin, u_end) for the rows of a flat figure inside `clip`, and for a solid's rows that may
// hold it.
template <class Visit>
void for_each_run(const RasterRecord& r, const std::vector<RasterSolid>& solids, const PixelBox& clip,
                  Visit&& visit) {
  const PixelBox box = common(r.bounds, clip);
  const bool solid = r.figure == Figure::kCone || r.figure == Figure::kShoot;
  const FlatShares f = solid ? FlatShares{} : shares_of(r);
  if (!solid && f.edge_on) return;
  for (std::int32_t v = box.v_lo; v < box.v_hi; ++v) {
    const double dv = v + 0.5 - r.v;
    Run run{box.u_lo - r.u, box.u_hi - r.u};
    const double a = f.a_v * dv, b = f.b_v * dv;
    switch (r.figure) {
      case Figure::kParallelogram:
        run.cut(f.a_u, a, -1.0, 1.0);
        run.cut(f.b_u, b, -1.0, 1.0);
        break;
      case Figure::kTriangle:
        run.cut(f.a_u, a, -1.0 / 3.0, 2.0 / 3.0);
        run.cut(f.b_u, b, -1.0 / 3.0, 2.0 / 3.0);
        run.cut(f.a_u + f.b_u, a + b, -2.0 / 3.0, 1.0 / 3.0);
        break;
      case Figure::kDisc: {  // |(a, b) + du (a_u, b_u)| <= 1
        const double p2 = f.a_u * f.a_u + f.b_u * f.b_u;
        const double middle = a * f.a_u + b * f.b_u, rest = a * f.b_u - b * f.a_u;
        const double root2 = p2 - rest * rest;
        if (!(root2 > 0.0)) continue;
        run.lo = std::max(run.lo, (-middle - std::sqrt(root2)) / p2);
        run.hi = std::min(run.hi, (-middle + std::sqrt(root2)) / p2);
        break;
      }
      case Figure::kCone:
      case Figure::kShoot: {
        const RasterSolid& s = solids[r.solid];
        run.cut(s.aside_u, s.aside_v * dv, -s.widest, s.widest);
      }
    }
    // Centres u + 1/2 in [lo, hi): a border shared by two figures belongs to one.
    const double first = std::ceil(run.lo + r.u - 0.5), end = std::ceil(run.hi + r.u - 0.5);
    if (!(first < end)) continue;
    const auto u_begin = std::max(box.u_lo, static_cast<std::int32_t>(first));
    const auto u_end = std::min(box.u_hi, static_cast<std::int32_t>(end));
    if (u_begin < u_end) visit(v, u_begin, u_end);
  }
}

// Upper bound of a cylinder's chords.
inline double longest_chord(const RasterSolid& solid) {
  return 2.0 * std::hypot(solid.radius, solid.highest);
}

// A point of a figure from two numbers in [0, 1) that spread over it as over the unit square: pixels and depth
// from its centre. Of a solid: its centre.
struct FigurePoint {
  double u = 0, v = 0, s = 0;
};
FigurePoint point_of(const RasterRecord& record, double x, double y);

}  // namespace sunfleck::trace
