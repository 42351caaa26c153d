#include "lighting/shade/bough_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lighting/shade/bough_way.h"
#include "lighting/shade/gauss_points.h"

namespace sunfleck {
namespace {

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
