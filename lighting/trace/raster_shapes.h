// What a picture of the sun is drawn from: leaves, discs and triangles as flat figures, wood and shoots as
// solids, all in pixel coordinates (raster_view.h), and the runs of pixels whose centres they cover.
#pragma once

#include <algorithm>
#include <array>
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
  double u = 0, v = 0;                           // of the centre; of a cone's base
  float s = 0, s_a = 0, s_b = 0;                 // depth there, and along half_u and half_v of a flat figure
  float a_du = 0, a_dv = 0, b_du = 0, b_dv = 0;  // half_u and half_v of a flat figure in pixels
  PixelBox bounds;                               // every pixel whose square the figure touches
  std::uint32_t element = kOnlyShades;
  std::uint32_t solid = 0;  // of a cone or shoot
  Figure figure = Figure::kParallelogram;
  bool small = false;  // may lie between the centres of all pixels
};

// A frustum's side or a cylinder, cut by lines along to_sun: t metres along the line from the plane through
// the base or centre, as polynomials of the pixels (du, dv) from there.
struct RasterSolid {
  double height_u = 0, height_v = 0, rise = 0;            // along the axis: per pixel, per metre of t
  double across_uu = 0, across_uv = 0, across_vv = 0;     // |vector from the axis|^2
  double run_u = 0, run_v = 0, run2 = 0;                  // its product with the way aside, and that squared
  double aside_u = 0, aside_v = 0;                        // distance from the plane of axis and sun
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

// Bands across the picture whose common part a figure is, or a solid lies in: the pixels of a row dv from the
// centre that a band holds are those with near <= du - slope dv <= far.
class Bands {
 public:
  // least <= p du + q dv <= most
  void cut(double p, double q, double least, double most) {
    constexpr double kTiny = 1e-30;
    const double inverse = 1.0 / (std::abs(p) > kTiny ? p : kTiny);
    const double x = least * inverse, y = most * inverse;
    band_[count_++] = {std::min(x, y), std::max(x, y), -q * inverse};
  }
  struct Run {
    double lo, hi;  // of du
  };
  void cut(double dv, Run& run) const {
    for (const Band& b : band_) {
      run.lo = std::max(run.lo, b.near + b.slope * dv);
      run.hi = std::min(run.hi, b.far + b.slope * dv);
    }
  }

 private:
  struct Band {
    double near = -1e30, far = 1e30, slope = 0;
  };
  std::array<Band, 3> band_;
  std::size_t count_ = 0;
};
// Of a parallelogram, a triangle or a solid; none for a disc.
Bands bands_of(const RasterRecord& record, const FlatShares& shares, const std::vector<RasterSolid>& solids);

// The run of a disc, |(a, b) + du (a_u, b_u)| <= 1, in row dv.
inline void cut_disc(const FlatShares& f, double dv, Bands::Run& run) {
  const double a = f.a_v * dv, b = f.b_v * dv, p2 = f.a_u * f.a_u + f.b_u * f.b_u;
  const double middle = a * f.a_u + b * f.b_u, rest = a * f.b_u - b * f.a_u;
  const double root = std::sqrt(std::max(0.0, p2 - rest * rest));
  run.lo = std::max(run.lo, (-middle - root) / p2);
  run.hi = std::min(run.hi, (-middle + root) / p2);
}

// Calls visit(v, u_begin, u_end) for the rows of a flat figure inside `clip`, and for a solid's rows that may
// hold it. A pixel belongs to a figure if its centre u + 1/2 lies in [lo, hi) of its row: a border shared by
// two figures belongs to one.
template <class Visit>
void for_each_run(const RasterRecord& r, const std::vector<RasterSolid>& solids, const PixelBox& clip,
                  Visit&& visit) {
  const PixelBox box = common(r.bounds, clip);
  const bool solid = r.figure == Figure::kCone || r.figure == Figure::kShoot;
  const FlatShares shares = solid ? FlatShares{} : shares_of(r);
  if (!solid && shares.edge_on) return;
  const Bands bands = bands_of(r, shares, solids);
  for (std::int32_t v = box.v_lo; v < box.v_hi; ++v) {
    const double dv = v + 0.5 - r.v;
    Bands::Run run{box.u_lo + 0.5 - r.u, box.u_hi + 0.5 - r.u};
    bands.cut(dv, run);
    if (r.figure == Figure::kDisc) cut_disc(shares, dv, run);
    const auto begin = static_cast<std::int32_t>(std::ceil(run.lo + r.u - 0.5));
    const auto end = static_cast<std::int32_t>(std::ceil(std::max(run.lo, run.hi) + r.u - 0.5));
    if (begin < end) visit(v, begin, std::min(end, box.u_hi));
  }
}

// Upper bound of a cylinder's chords.
inline double longest_chord(const RasterSolid& solid) {
  return 2.0 * std::hypot(solid.radius, solid.highest);
}

// A point of a figure from two numbers in [0, 1) that spread over it as over the unit square: pixels and
// depth from its centre. Of a solid: its centre.
struct FigurePoint {
  double u = 0, v = 0, s = 0;
};
FigurePoint point_of(const RasterRecord& record, double x, double y);

}  // namespace sunfleck::trace
