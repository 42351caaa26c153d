#include "lighting/render/raster_shade.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/solids.h"

namespace sunfleck {
namespace {

void place(const SeenTree& tree, const CameraRay& ray, double distance_m, RayHit& hit) {
  hit.instance = tree.placed.instance;
  hit.distance_m = distance_m;
  hit.position_m = ray.origin_m + distance_m * ray.direction;
  hit.on_original_m = hit.position_m - tree.placed.shift_m;
}

}  // namespace

RayHit RasterShader::ground_hit(const CameraRay& ray) const {
  const Forest& forest = parts_.scene.forest();
  const Vec3 n = forest.terrain.normal();
  const double height = ray.origin_m.z - forest.terrain.height_at(ray.origin_m.x, ray.origin_m.y);
  RayHit hit;
  hit.kind = HitKind::kGround;
  hit.front = glm::dot(n, ray.direction) < 0.0;
  hit.normal = hit.front ? n : -n;
  hit.distance_m = std::max(0.0, -height * n.z / glm::dot(n, ray.direction));
  hit.position_m = ray.origin_m + hit.distance_m * ray.direction;
  hit.position_m -= shift_of(forest, cell_at(forest, hit.position_m));
  hit.position_m.z = forest.terrain.height_at(hit.position_m.x, hit.position_m.y);
  hit.on_original_m = hit.position_m;
  return hit;
}

RayHit RasterShader::flat_hit(const SeenTree& tree, const FlatFigure& figure, const CameraRay& ray) const {
  const Instance& at = parts_.scene.forest().instances[tree.placed.instance];
  const Vec3 n = glm::normalize(world_direction_from_tree(at, glm::cross(Vec3(figure.u), Vec3(figure.v))));
  const Vec3 centre = world_from_tree(at, Vec3(figure.centre)) + tree.placed.shift_m;
  const double along = glm::dot(n, ray.direction);
  RayHit hit;
  hit.kind = figure.kind;
  hit.local = figure.local;
  hit.front = along < 0.0;
  hit.normal = hit.front ? n : -n;
  place(tree, ray, along != 0.0 ? glm::dot(n, centre - ray.origin_m) / along : 0.0, hit);
  return hit;
}

RayHit RasterShader::round_hit(const SeenTree& tree, const RoundFigure& figure, const CameraRay& ray) const {
  const Instance& at = parts_.scene.forest().instances[tree.placed.instance];
  const Vec3 base = world_from_tree(at, Vec3(figure.base)) + tree.placed.shift_m;
  const Vec3 axis = glm::normalize(world_direction_from_tree(at, Vec3(figure.axis)));
  const double scale = at.scale, length = scale * figure.length;
  RayHit hit;
  hit.local = figure.local;
  hit.kind = figure.extinction_per_m > 0.0f ? HitKind::kFoliage : HitKind::kWood;
  hit.front = true;
  if (hit.kind == HitKind::kWood) {
    const trace::ConeFrustum cone{base, axis, length, scale * figure.radius, figure.taper};
    const auto met =
        trace::intersect(cone, ray.origin_m, ray.direction, 0.0, std::numeric_limits<double>::infinity());
    if (met) {
      hit.front = met->from_outside;
      hit.normal = hit.front ? met->outward_normal : -met->outward_normal;
      place(tree, ray, met->t, hit);
      return hit;
    }
  }
  // Where the ray comes nearest to the axis.
  const Vec3 from = base - ray.origin_m;
  const double cosine = glm::dot(axis, ray.direction), sine2 = 1.0 - cosine * cosine;
  const double height =
      sine2 > 1e-12 ? (cosine * glm::dot(from, ray.direction) - glm::dot(from, axis)) / sine2 : 0.0;
  const Vec3 nearest = from + std::clamp(height, 0.0, length) * axis;
  const double distance = std::max(0.0, glm::dot(nearest, ray.direction));
  place(tree, ray, distance, hit);
  Vec3 normal = distance * ray.direction - nearest;  // from the axis to the ray
  normal -= glm::dot(normal, axis) * axis;
  hit.normal = glm::length(normal) > 0.0 ? glm::normalize(normal) : -ray.direction;
  return hit;
}

RayHit RasterShader::hit_at(std::uint32_t number, const CameraRay& ray) const {
  if (number == kSkyNumber) return {};
  if (number == kGroundNumber) return ground_hit(ray);
  const SeenTree& tree = trees_.trees[trees_.tree_of(number)];
  const std::size_t figure = number - tree.placed.first_number;
  const PrototypeFigures& figures = *tree.placed.figures;
  return figure < figures.flats.size() ? flat_hit(tree, figures.flats[figure], ray)
                                       : round_hit(tree, figures.rounds[figure - figures.flats.size()], ray);
}

// Of a slanted surface, the side of the square as large as what the pixel shows of it.
double RasterShader::pixel_m(const RayHit& hit, const Vec3& direction) const {
  const double across = (frame_.perspective ? hit.distance_m : 1.0) / frame_.px_per_unit;
  return across / std::sqrt(std::max(0.01, std::abs(glm::dot(hit.normal, direction))));
}

Vec3 RasterShader::sky_at(const Vec2& place_px) const {
  return parts_.light.background(rays_.through(place_px.x, place_px.y)->direction);
}

bool RasterShader::near_disc(const Vec2& place_px) const {
  if (!parts_.light.has_beam() || light_.sun_half_angle_rad == 0.0) return false;
  const double pixel_rad = frame_.perspective ? 1.5 / frame_.px_per_unit : 0.0;
  const Vec3 direction = rays_.through(place_px.x, place_px.y)->direction;
  return glm::length(direction - light_.to_sun) < 1.01 * light_.sun_half_angle_rad + pixel_rad;
}

Shader::SunAndRest RasterShader::light_at(std::uint32_t number, const Vec2& place_px) const {
  const auto ray = rays_.through(place_px.x, place_px.y);
  if (number == kSkyNumber) return {parts_.light.background(ray->direction), Vec3(0.0)};
  const RayHit hit = hit_at(number, *ray);
  const double footprint_m = pixel_m(hit, ray->direction);
  if (hit.kind == HitKind::kFoliage) return shader_.leaf_parts(hit, -ray->direction, footprint_m);
  if (hit.kind == HitKind::kGround && !hit.front) return {};  // the dark below
  const Vec3 share = parts_.surfaces.at(hit, footprint_m).reflect / kPi;
  const Vec3 rest =
      hit.kind == HitKind::kGround
          ? gathered_.on_ground(hit.position_m, footprint_m, frame_.perspective ? hit.distance_m : 0.0)
          : gathered_.on_wood(hit);
  return {share * rest, share * shader_.open_sun(hit.normal)};
}

}  // namespace sunfleck
