#include "lighting/shade/bough_light.h"

#include <algorithm>
#include <cmath>

#include "lighting/shade/bough_lanes.h"
#include "lighting/shade/bough_line.h"
#include "lighting/shade/gauss_points.h"
#include "lighting/shade/needle.h"
#include "sim/base/contract.h"

namespace sunfleck {
namespace {

constexpr std::size_t kPoints = kGauss8.at.size();

// Light and viewer as one pair.
struct Pair {
  const BoughDirection& ray;  // away from the viewer
  const BoughDirection& to_light;
  double cos_between;    // V.L
  double decorrelation;  // |V - L| / ell; infinite without hot spot
};

Pair pair_of(const BoughVolume& v, const BoughDirection& ray, const BoughDirection& to_light) {
  const double cosine = -glm::dot(ray.along, to_light.along);
  const double apart = glm::length(ray.along + to_light.along);
  return {ray, to_light, cosine,
          v.hot_spot_length > 0 ? apart / v.hot_spot_length : std::numeric_limits<double>::infinity()};
}

// Cosine and sine of the angle between needle and direction at a place on the line.
double needle_cosine(const LinePlace& p) { return 0.5 * (p.plus * p.plus - p.minus * p.minus); }

// sqrt(sigma_V sigma_L) where the light ray is `u` from the point.
double joint_extinction(const BoughVolume& v, const Pair& pair, const BoughLine& light_line,
                        const Vec3& point, double u) {
  const LinePlace light = light_line.place(light_line.t(u, pair.to_light), pair.to_light);
  const Vec3 there = point + u * pair.to_light.along;
  // Azimuth is that of `there`; only the part of the ray's direction along the radius matters.
  const double radial = (there.x * pair.ray.across.x + there.y * pair.ray.across.y) / light.rho;
  const double cosine = pair.ray.constant + pair.ray.slope * std::clamp(radial, -1.0, 1.0);
  const double sine_view = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return v.density * std::sqrt(sine_view * light.sin_needle()) / light.rho;
}

// c of the header over a way of length `way` towards the light. Three points where the exponential is, or its
// mean place alone where it is narrow against the bough.
double shared_depth(const BoughVolume& v, const Pair& pair, const BoughLine& light_line, const Vec3& point,
                    double way) {
  const double k = pair.decorrelation;
  if (!std::isfinite(k) || way <= 0) return 0;
  const double mass = -std::expm1(-k * way);  // k times the integral of the exponential
  if (k * way > 8) return joint_extinction(v, pair, light_line, point, 1 / k) * mass / k;
  constexpr std::array<double, 3> at{0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double u = k * way > 1e-6 ? -std::log1p(-at[i] * mass) / k : at[i] * way;
    sum += weight[i] * joint_extinction(v, pair, light_line, point, u);
  }
  return sum * (k * way > 1e-6 ? mass / k : way);
}

// Share of light that arrives at `point` and goes back through depth `view_depth`: T of the header.
double share_both_ways(const BoughVolume& v, const Pair& pair, const Vec3& point, double view_depth) {
  const BoughSpans spans = bough_spans(v, point, pair.to_light);
  const BoughLine line(v, point, pair.to_light);
  double light_depth = 0;
  for (int i = 0; i < spans.count; ++i)
    light_depth +=
        depth_between(line.place(line.t(spans.span[i].from, pair.to_light), pair.to_light),
                      line.place(line.t(spans.span[i].to, pair.to_light), pair.to_light), pair.to_light);
  const double way = spans.count > 0 ? spans.span[0].to : 0;
  const double shared = shared_depth(v, pair, line, point, way);
  return std::exp(-std::max(view_depth + light_depth - shared, std::max(view_depth, light_depth)));
}

// Rd of the needle at `point` from its direction's cosines.
double diffuse_at(const Pair& pair, const LinePlace& place, const Vec3& point) {
  const double radial = (point.x * pair.to_light.across.x + point.y * pair.to_light.across.y) / place.rho;
  const double cos_light = pair.to_light.constant + pair.to_light.slope * std::clamp(radial, -1.0, 1.0);
  const double sin_light = std::sqrt(std::max(0.0, 1 - cos_light * cos_light));
  const double product = place.sin_needle() * sin_light;
  const double cosine = product > 0 ? (pair.cos_between + needle_cosine(place) * cos_light) / product : 0;
  return needle_diffuse(NeedleAngles<double>{place.sin_needle(), sin_light, std::clamp(cosine, -1.0, 1.0)});
}

// One stretch inside: adds to `reflected`, returns its depth. Integrated over q = asinh(t / offset), in which
// the density's peak at the axis is flat, by `panels` groups of eight points.
double add_span_light(const BoughVolume& v, const Vec3& origin, const Pair& pair,
                      const BoughSpans::Span& span, double depth_before, int panels, double& reflected) {
  const BoughDirection& ray = pair.ray;
  const BoughLine line(v, origin, ray);
  const double from = line.t(span.from, ray), to = line.t(span.to, ray);
  const LinePlace start = line.place(from, ray);
  const double q_from = std::asinh(from / line.offset);
  const double q_way = (std::asinh(to / line.offset) - q_from) / panels;
  for (int panel = 0; panel < panels; ++panel)
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double t = line.offset * std::sinh(q_from + (panel + kGauss8.at[i]) * q_way);
      const LinePlace place = line.place(t, ray);
      const Vec3 point = origin + (t - line.start) / ray.sine * ray.along;
      const double depth = depth_before + depth_between(start, place, ray);
      reflected += kGauss8.weight[i] * q_way * ray.scale * place.sin_needle() *
                   diffuse_at(pair, place, point) * share_both_ways(v, pair, point, depth);
    }
  return depth_between(start, line.place(to, ray), ray);
}

Vec3 needle_axis_at(const BoughVolume& v, const Vec3& point) {
  const double rho = std::hypot(point.x, point.y);
  const Vec2 out = rho > 0 ? Vec2(point.x, point.y) / rho : Vec2(1, 0);
  return {v.sin_aperture * out.x, v.sin_aperture * out.y, v.cos_aperture};
}

}  // namespace

BoughLight bough_light_exact(const BoughVolume& v, const Vec3& origin, const BoughDirection& ray,
                             const BoughDirection& to_light, int panels) {
  SUNFLECK_EXPECTS(panels > 0);
  const BoughSpans spans = bough_spans(v, origin, ray);
  const Pair pair = pair_of(v, ray, to_light);
  double depth = 0, reflected = 0;
  for (int i = 0; i < spans.count; ++i)
    depth += add_span_light(v, origin, pair, spans.span[i], depth, panels, reflected);
  const double opacity = -std::expm1(-depth);
  return {opacity, std::min(reflected, opacity)};
}

BoughLight bough_light(const BoughVolume& v, const Vec3& origin, const BoughDirection& ray,
                       const BoughDirection& to_light) {
  const BoughSpans spans = bough_spans(v, origin, ray);
  float depth = 0, reflected = 0;
  for (int i = 0; i < spans.count; ++i)
    reflected += stretch_light(v, origin, ray, to_light, spans.span[i], depth);
  const double opacity = -std::expm1(-static_cast<double>(depth));
  return {opacity, std::min<double>(reflected, opacity)};
}

std::optional<BoughEvent> bough_event(const BoughVolume& v, const Vec3& origin, const BoughDirection& ray,
                                      double uniform) {
  SUNFLECK_EXPECTS(uniform >= 0 && uniform < 1);
  const BoughSpans spans = bough_spans(v, origin, ray);
  const BoughLine line(v, origin, ray);
  const double wanted = -std::log1p(-uniform);
  double left = wanted;  // depth still to go
  for (int i = 0; i < spans.count; ++i) {
    const double from = line.t(spans.span[i].from, ray), to = line.t(spans.span[i].to, ray);
    const LinePlace start = line.place(from, ray);
    const double depth = depth_between(start, line.place(to, ray), ray);
    if (left >= depth) {
      left -= depth;
      continue;
    }
    // Newton's steps in q, where depth is nearly a straight line, kept inside a shrinking bracket.
    double lo = std::asinh(from / line.offset), hi = std::asinh(to / line.offset);
    double q = lo + (hi - lo) * left / depth;
    for (int step = 0; step < 8; ++step) {
      const LinePlace place = line.place(line.offset * std::sinh(q), ray);
      const double miss = depth_between(start, place, ray) - left;
      if (std::abs(miss) < 1e-5) break;  // of a depth: closer than a tenth of a needle's radius
      (miss > 0 ? hi : lo) = q;
      q -= miss / (ray.scale * place.sin_needle());
      if (!(q > lo && q < hi)) q = 0.5 * (lo + hi);
    }
    const double distance = (line.offset * std::sinh(q) - line.start) / ray.sine;
    const Vec3 point = origin + distance * ray.along;
    return BoughEvent{distance, point, needle_axis_at(v, point), wanted};
  }
  return std::nullopt;
}

double event_light(const BoughVolume& v, const BoughDirection& ray, const BoughEvent& event,
                   const BoughDirection& to_light) {
  const Pair pair = pair_of(v, ray, to_light);
  // Given that the ray came here, the chance of light is the share both ways over the share of the view.
  const double share = share_both_ways(v, pair, event.point, event.depth) * std::exp(event.depth);
  const NeedleAngles<double> angles = needle_angles(event.needle_axis, -ray.along, to_light.along);
  return needle_diffuse(angles) * std::min(1.0, share);
}

BoughLight bough_strip(const BoughVolume& v, double half_width, const Vec3& to_viewer, const Vec3& to_light,
                       int columns) {
  SUNFLECK_EXPECTS(columns > 0 && half_width > 0);
  const BoughDirection ray = bough_direction(v, -to_viewer), light = bough_direction(v, to_light);
  const double back = 4 * v.outer_radius / ray.sine;
  BoughLight sum;
  for (int i = 0; i < columns; ++i) {
    const double x = half_width * (2 * (i + 0.5) / columns - 1);
    const Vec3 origin = Vec3(ray.across.y * x, -ray.across.x * x, 0) - back * ray.along;
    const BoughLight one = bough_light(v, origin, ray, light);
    sum.opacity += one.opacity / columns;
    sum.reflected += one.reflected / columns;
  }
  return sum;
}

}  // namespace sunfleck
