// See drop_rays.h.
#include "lighting/canopy/drop_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lighting/trace/surface_sampler.h"

namespace sunfleck {

namespace {

// Rays of neighbouring places follow each other, strip by strip of so many rows: they find the same trees in
// the caches.
constexpr std::size_t kStripRows = 4;

// Where the line p + t d runs inside the box, if it does.
std::optional<double> entry_of(const Box& box, const Vec3& p, const Vec3& d) {
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) {
      if (p[axis] < box.lo[axis] || p[axis] > box.hi[axis]) return std::nullopt;
      continue;
    }
    const double a = (box.lo[axis] - p[axis]) / d[axis], b = (box.hi[axis] - p[axis]) / d[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? std::optional(enter) : std::nullopt;
}

}  // namespace

DropRays::DropRays(const StandScene& scene, const Vec3& to_source, double half_angle_rad, double rays_on_map)
    : scene_(scene), to_source_(to_source), half_angle_rad_(half_angle_rad) {
  const double facing = scene.ground().facing(to_source);
  if (!(facing > 0.0)) return;
  cover(scene);
  const double off_normal = std::acos(std::min(1.0, glm::dot(to_source, scene.ground().normal)));
  most_facing_ = std::cos(std::max(0.0, off_normal - half_angle_rad)) / scene.ground().normal.z;
  const Vec2 map_m = scene.ground().size_m();
  const double area_m2 = size_m_.x * size_m_.y;
  const double wanted = std::max(1.0, rays_on_map * area_m2 / (map_m.x * map_m.y));
  columns_ = static_cast<std::size_t>(std::max(1.0, std::round(std::sqrt(wanted * size_m_.x / size_m_.y))));
  rows_ = static_cast<std::size_t>(std::max(1.0, std::round(wanted / static_cast<double>(columns_))));
  quantum_m2_ = facing * area_m2 / static_cast<double>(count());
}

// The map and the shadow of the box round all that is asked about; where nothing surrounds it, with a margin
// as wide as the forest is high for the light that the ground there throws back.
void DropRays::cover(const StandScene& scene) {
  const StandGround& ground = scene.ground();
  lo_m_ = ground.lo_m;
  size_m_ = ground.size_m();
  if (ground.periodic) return;
  Vec2 hi = lo_m_ + size_m_;
  const Box& box = scene.region();
  const Vec3 n = ground.normal;
  const double margin = scene.has_surroundings() ? 0.0 : scene.ceiling_m();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) ? box.hi.x : box.lo.x, (corner & 2) ? box.hi.y : box.lo.y,
                 (corner & 4) ? box.hi.z : box.lo.z);
    const double height = std::max(0.0, scene.height_above_ground(p));
    const Vec3 shadow = p - to_source_ * (height * n.z / glm::dot(to_source_, n));
    lo_m_ = glm::min(lo_m_, glm::min(Vec2(p), Vec2(shadow)) - margin);
    hi = glm::max(hi, glm::max(Vec2(p), Vec2(shadow)) + margin);
  }
  size_m_ = hi - lo_m_;
}

// On the map, or so close to the trees that what the ground throws back reaches them.
bool DropRays::is_near(const Vec3& aim_m) const {
  if (scene_.ground().contains(aim_m.x, aim_m.y)) return true;
  const Box& box = scene_.bounds();
  const double margin = scene_.ceiling_m();
  return aim_m.x > box.lo.x - margin && aim_m.x < box.hi.x + margin && aim_m.y > box.lo.y - margin &&
         aim_m.y < box.hi.y + margin;
}

// Rays carry the same energy per ground area, so that directions of the cone come as often as they are high:
// light from them falls on the ground in proportion to facing().
Vec3 DropRays::from_cone(RandomStream& random) const {
  const StandGround& ground = scene_.ground();
  for (int tries = 0; tries < 64; ++tries) {
    const Vec3 towards = trace::cone_direction(to_source_, half_angle_rad_, random);
    const double facing = ground.facing(towards);
    if (facing > 1e-3 && random.uniform() * most_facing_ < facing) return towards;
  }
  return to_source_;
}

DropRay DropRays::ray(std::size_t i, RandomStream& random) const {
  const std::size_t strip = i / (kStripRows * columns_), within = i % (kStripRows * columns_);
  const std::size_t rows = std::min(kStripRows, rows_ - strip * kStripRows);
  const Vec2 place(static_cast<double>(within / rows),
                   static_cast<double>(strip * kStripRows + within % rows));
  const Vec2 jitter(random.uniform(), random.uniform());
  const Vec2 aim =
      lo_m_ + size_m_ * (place + jitter) / Vec2(static_cast<double>(columns_), static_cast<double>(rows_));
  DropRay ray;
  ray.aim_m = {aim, scene_.forest().terrain.height_at(aim.x, aim.y)};
  const Vec3 towards = half_angle_rad_ > 0.0 ? from_cone(random) : to_source_;
  ray.direction = -towards;
  const Vec3& normal = scene_.ground().normal;
  if (scene_.ground().periodic) {
    // Height above the ground plane grows by dot(towards, n) / n.z per metre.
    const double way_m = 1.001 * scene_.ceiling_m() * normal.z / glm::dot(towards, normal);
    ray.origin_m = ray.aim_m + way_m * towards;
    return ray;
  }
  if (scene_.has_surroundings() && !scene_.ground().contains(aim.x, aim.y) &&
      !entry_of(scene_.region(), ray.aim_m, ray.direction)) {
    ray.may_hit = false;
    ray.is_far = true;
    return ray;
  }
  const auto enter = entry_of(scene_.bounds(), ray.aim_m, ray.direction);
  ray.may_hit = enter.has_value();
  ray.is_far = !ray.may_hit && !is_near(ray.aim_m);
  // Just outside the box, or at the ground below it.
  const double before_m = std::min(enter.value_or(0.0), 0.0) - 1e-3 * scene_.ceiling_m();
  ray.origin_m = ray.aim_m + before_m * ray.direction;
  return ray;
}

}  // namespace sunfleck
