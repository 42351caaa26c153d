#include "lighting/shade/bough.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting/shade/bough_line.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// z - rho cot(aperture): which whorl a point belongs to.
double whorl_height(const BoughVolume& v, const Vec3& p) {
  return p.z - std::hypot(p.x, p.y) * v.cos_aperture / v.sin_aperture;
}

// Borders along a ray in ascending order, between the ends it was made with.
struct Roots {
  int count = 2;
  std::array<double, 6> at{};
  Roots(double from, double to) : at{from, to} {}
  void add(double s) {
    if (!(s > at[0] && s < at[count - 1])) return;
    int i = count++;
    for (; at[i - 1] > s; --i) at[i] = at[i - 1];
    at[i] = s;
  }
};

// Where whorl_height is `height` along the ray: (z - height)^2 sin^2 = rho^2 cos^2, both nappes.
void add_cone_roots(const BoughVolume& v, const Vec3& o, const Vec3& d, double height, Roots& roots) {
  const double s2 = v.sin_aperture * v.sin_aperture, c2 = v.cos_aperture * v.cos_aperture;
  const double z = o.z - height;
  const double a = c2 * (d.x * d.x + d.y * d.y) - s2 * d.z * d.z;
  const double b = c2 * (o.x * d.x + o.y * d.y) - s2 * z * d.z;  // half the linear term
  const double c = c2 * (o.x * o.x + o.y * o.y) - s2 * z * z;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return;
  const double far = -(b + std::copysign(std::sqrt(discriminant), b));
  if (a != 0) roots.add(far / a);
  if (far != 0) roots.add(c / far);
}

void add_span(BoughSpans& spans, double from, double to) {
  if (spans.count > 0 && spans.span[spans.count - 1].to == from) {
    spans.span[spans.count - 1].to = to;
  } else if (spans.count < 2) {
    spans.span[spans.count++] = {from, to};
  }
}

// Entry and exit of the outer cylinder; false if the ray misses it or has left it.
bool cylinder_span(const BoughVolume& v, const Vec3& o, const BoughDirection& d, double& from, double& to) {
  const double offset = o.x * d.across.y - o.y * d.across.x;
  const double half2 = v.outer_radius * v.outer_radius - offset * offset;
  if (!(half2 > 0)) return false;
  const double middle = -(o.x * d.across.x + o.y * d.across.y), half = std::sqrt(half2);
  to = (middle + half) / d.sine;
  from = std::max(0.0, (middle - half) / d.sine);
  return from < to;
}

}  // namespace

void validate(const Bough& bough, const char* where) {
  validate(bough.cone, where);
  if (!(bough.spacing > 0) || !std::isfinite(bough.spacing))
    throw_invalid(where, "cone spacing is not a positive number", "> 0");
  if (bough.cones < 0) throw_invalid(where, "negative number of cones", "0 (endless) or more");
  if (!(bough.hot_spot_radii >= 0) || !std::isfinite(bough.hot_spot_radii))
    throw_invalid(where, "hot spot length is negative or not a number", "0 (none) to about 4 needle radii");
}

BoughVolume bough_volume(const Bough& bough) {
  validate(bough, "bough");
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const NeedleCone& cone = bough.cone;
  BoughVolume v;
  v.sin_aperture = std::sin(cone.aperture_rad);
  v.cos_aperture = std::cos(cone.aperture_rad);
  v.outer_radius = cone.length * v.sin_aperture + cone.radius;
  v.density = cone.needles * cone.radius / (kPi * bough.spacing * v.sin_aperture);
  v.hot_spot_length = bough.hot_spot_radii * cone.radius;
  v.lowest = bough.cones > 0 ? -0.5 * bough.spacing : -infinity;
  v.highest = bough.cones > 0 ? (bough.cones - 0.5) * bough.spacing : infinity;
  return v;
}

BoughDirection bough_direction(const BoughVolume& v, const Vec3& direction) {
  BoughDirection d;
  const double sine = std::hypot(direction.x, direction.y);
  d.across = sine > 0 ? Vec2(direction.x, direction.y) / sine : Vec2(1, 0);
  d.sine = std::max(sine, kLeastSine);
  const double cosine = std::copysign(std::sqrt(std::max(0.0, 1 - d.sine * d.sine)), direction.z);
  d.along = {d.sine * d.across.x, d.sine * d.across.y, cosine};
  const double s = v.sin_aperture, c = v.cos_aperture;
  d.constant = c * cosine;
  d.slope = s * d.sine;
  d.one_minus_near = 0.5 * ((cosine - c) * (cosine - c) + (d.sine - s) * (d.sine - s));
  d.one_plus_far = 0.5 * ((cosine + c) * (cosine + c) + (d.sine - s) * (d.sine - s));
  d.minus_near = std::sqrt(d.one_minus_near);
  d.plus_near = std::sqrt(2 - d.one_minus_near);
  d.plus_far = std::sqrt(d.one_plus_far);
  d.minus_far = std::sqrt(2 - d.one_plus_far);
  d.sin_near = d.minus_near * d.plus_near;
  d.sin_far = d.minus_far * d.plus_far;
  d.scale = v.density / d.sine;
  return d;
}

BoughSpans bough_spans(const BoughVolume& v, const Vec3& origin, const BoughDirection& d) {
  BoughSpans spans;
  double from = 0, to = 0;
  if (!cylinder_span(v, origin, d, from, to)) return spans;
  if (!std::isfinite(v.lowest)) return {1, {{{from, to}, {}}}};
  Roots roots(from, to);
  add_cone_roots(v, origin, d.along, v.lowest, roots);
  add_cone_roots(v, origin, d.along, v.highest, roots);
  for (int i = 0; i + 1 < roots.count; ++i) {
    if (!(roots.at[i] < roots.at[i + 1])) continue;
    const double height = whorl_height(v, origin + 0.5 * (roots.at[i] + roots.at[i + 1]) * d.along);
    if (height >= v.lowest && height <= v.highest) add_span(spans, roots.at[i], roots.at[i + 1]);
  }
  return spans;
}

double bough_depth(const BoughVolume& v, const Vec3& origin, const BoughDirection& d,
                   const BoughSpans& spans) {
  const BoughLine line(v, origin, d);
  double depth = 0;
  for (int i = 0; i < spans.count; ++i)
    depth += depth_between(line.place(line.t(spans.span[i].from, d), d),
                           line.place(line.t(spans.span[i].to, d), d), d);
  return depth;
}

double bough_depth(const BoughVolume& v, const Vec3& origin, const BoughDirection& d) {
  return bough_depth(v, origin, d, bough_spans(v, origin, d));
}

double bough_extinction(const BoughVolume& v, const Vec3& point, const BoughDirection& d) {
  const BoughLine line(v, point, d);
  const LinePlace place = line.place(line.start, d);
  return v.density * place.sin_needle() / place.rho;
}

}  // namespace sunfleck
