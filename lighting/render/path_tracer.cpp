#include "lighting/render/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/surface_sampler.h"

namespace sunfleck {
namespace {

constexpr double kLightestWeight = 0.5;
// Only light caught between surfaces that absorb nothing gets this far.
constexpr int kMostBounces = 20000;

double brightest(const Vec3& v) { return std::max({v.x, v.y, v.z}); }

RayStart leaving(const RayHit& hit, bool this_side, const Surface& surface) {
  if (surface.is_shoot) return {.cast = hit.cast};
  return start_from(hit, this_side);
}

// Share of going on by reflection, of a flat surface.
double reflection_chance(const Surface& s, const Vec3& weight) {
  const double reflect = brightest(weight * s.reflect), pass = brightest(weight * s.pass);
  return reflect + pass > 0.0 ? reflect / (reflect + pass) : 1.0;
}

// Density per steradian with which a path goes on from a surface into a direction.
double onward_density(const Surface& s, double reflect_chance, const Vec3& direction) {
  if (s.is_shoot) return 0.25 / kPi;
  const double cosine = glm::dot(s.normal, direction);
  return (cosine > 0.0 ? reflect_chance : 1.0 - reflect_chance) * std::abs(cosine) / kPi;
}

Vec3 any_direction(double a, double b) {
  const double z = 1.0 - 2.0 * a, across = std::sqrt(std::max(0.0, 1.0 - z * z)), turn = 2.0 * kPi * b;
  return {across * std::cos(turn), across * std::sin(turn), z};
}

}  // namespace

struct PathTracer::Path {
  Vec3 origin_m, direction;
  RayStart from;
  Vec3 weight{1};
  double density_per_sr = 0;  // with which the direction was drawn; 0: by the camera
};

PathTracer::PathTracer(const PictureScene& scene, const SurfaceTable& surfaces, const PictureLight& light)
    : scene_(scene), surfaces_(surfaces), light_(light) {}

Vec3 PathTracer::radiance(Vec3 origin_m, Vec3 direction, PathSamples& samples, std::uint8_t cast) const {
  Path path{origin_m, direction, {.cast = cast}, Vec3(1.0), 0.0};
  Vec3 found(0.0);
  for (int bounce = 0; bounce < kMostBounces; ++bounce) {
    const RayHit hit = scene_.closest_hit(path.origin_m, path.direction, path.from);
    if (hit.kind == HitKind::kSky) return found + path.weight * sky_met(path);
    if (hit.kind == HitKind::kGround && !hit.front) return found;  // the dark below
    const Surface surface = surfaces_.at(hit);
    const auto lights = samples.next(), onward = samples.next();
    found += path.weight * (sun(hit, surface, path, {lights[0], lights[1]}) +
                            sky(hit, surface, path, {lights[2], lights[3]}));
    if (!go_on(hit, surface, onward, path)) return found;
  }
  return found;
}

// A camera sees the sun's disc; paths found it at the surface before.
Vec3 PathTracer::sky_met(const Path& path) const {
  if (path.density_per_sr == 0.0) return light_.background(path.direction);
  const double by_sky = light_.sky_density_per_sr(path.direction);
  return light_.sky(path.direction) * (path.density_per_sr / (path.density_per_sr + by_sky));
}

// Irradiance of the direction times what the surface gives of it towards the path, nothing in the way.
Vec3 PathTracer::given(const RayHit& hit, const Surface& surface, const Path& path,
                       const Vec3& to_light) const {
  const Vec3 share = scattering(surface, to_light, -path.direction) * cosine_factor(surface, to_light);
  const bool this_side = glm::dot(surface.normal, to_light) > 0.0;
  if (!(brightest(share) > 0.0)) return Vec3(0.0);
  const bool in_shade = scene_.occluded(hit.on_original_m, to_light, leaving(hit, this_side, surface));
  return in_shade ? Vec3(0.0) : share;
}

Vec3 PathTracer::sun(const RayHit& hit, const Surface& surface, const Path& path, const Vec2& number) const {
  if (!light_.has_beam()) return Vec3(0.0);
  return given(hit, surface, path, light_.towards_sun(number)) * light_.beam_w_m2();
}

Vec3 PathTracer::sky(const RayHit& hit, const Surface& surface, const Path& path, const Vec2& number) const {
  if (!light_.has_sky()) return Vec3(0.0);
  const PictureLight::Draw draw = light_.draw_sky(number);
  const double by_path = onward_density(surface, reflection_chance(surface, path.weight), draw.direction);
  return given(hit, surface, path, draw.direction) * light_.sky(draw.direction) /
         (draw.density_per_sr + by_path);
}

bool PathTracer::go_on(const RayHit& hit, const Surface& surface, const std::array<double, 4>& numbers,
                       Path& path) const {
  const double chance = reflection_chance(surface, path.weight);
  const Vec3 to_viewer = -path.direction;
  const bool this_side = surface.is_shoot || numbers[0] < chance;
  path.direction = surface.is_shoot ? any_direction(numbers[1], numbers[2])
                                    : trace::cosine_direction(this_side ? surface.normal : -surface.normal,
                                                              numbers[1], numbers[2]);
  path.density_per_sr = onward_density(surface, chance, path.direction);
  if (!(path.density_per_sr > 0.0)) return false;
  path.weight *= scattering(surface, path.direction, to_viewer) *
                 (cosine_factor(surface, path.direction) / path.density_per_sr);
  const double heaviest = brightest(path.weight);
  const double survives = std::min(1.0, heaviest / kLightestWeight);
  if (!(numbers[3] < survives)) return false;
  path.weight /= survives;
  path.origin_m = hit.on_original_m;
  path.from = leaving(hit, this_side, surface);
  return true;
}

}  // namespace sunfleck
