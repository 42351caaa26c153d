#include "lighting/render/shader.h"

#include <algorithm>
#include <cmath>

#include "lighting/render/leaf_flecks.h"
#include "lighting/trace/surface_sampler.h"

namespace sunfleck {

Vec3 Shader::radiance(const RayHit& hit, const Vec3& direction, PathSamples& numbers) const {
  if (hit.kind == HitKind::kSky) return parts_.light.background(direction);
  if (hit.kind == HitKind::kGround && !hit.front) return Vec3(0.0);  // the dark below
  return hit.kind == HitKind::kFoliage ? leaf_seen(hit, -direction, numbers)
                                       : parts_.surfaces.at(hit).reflect / kPi * irradiance(hit, numbers);
}

std::size_t Shader::element_of(const RayHit& hit) const {
  return parts_.index.first_element(hit.instance) + parts_.scene.original_element(hit);
}

const ElementLight& Shader::light_of(const RayHit& hit) const { return parts_.map.elements[element_of(hit)]; }

Vec3 Shader::diffuse(const FaceLight& face) const {
  return static_cast<double>(face.sky_w_m2) * parts_.colour.sky_tint +
         static_cast<double>(face.scattered_w_m2) * mean_.scatter_tint;
}

Vec3 Shader::total(const FaceLight& face) const {
  return static_cast<double>(face.direct_w_m2) * parts_.colour.sun_tint + diffuse(face);
}

Vec3 Shader::leaf_seen(const RayHit& hit, const Vec3& to_viewer, PathSamples& numbers) const {
  const Surface s = parts_.surfaces.at(hit);
  const auto sun_at = numbers.next();
  if (parts_.leaf_sun == LeafSun::kStored) return leaf_sunlit_as_stored(hit, s, to_viewer);
  const Vec2 of_disc(sun_at[0], sun_at[1]);
  return leaf_lit(hit, s, [&](const FaceLight& face) { return diffuse(face); }) +
         (parts_.leaf_sun == LeafSun::kTile ? sun_flecked(hit, s, to_viewer, of_disc)
                                            : sun_scattered(hit, s, to_viewer, of_disc));
}

// Its gloss as if all of it came from the middle of the disc.
Vec3 Shader::leaf_sunlit_as_stored(const RayHit& hit, const Surface& s, const Vec3& to_viewer) const {
  if (s.gloss == 0.0 || s.is_shoot)
    return leaf_lit(hit, s, [&](const FaceLight& face) { return total(face); });
  const ElementLight& light = light_of(hit);
  const FaceLight &this_side = hit.front ? light.front : light.back,
                  &other = hit.front ? light.back : light.front;
  const Vec3 to_sun = parts_.light.towards_sun({0.0, 0.0});
  const Vec3 sun = scattering(s, to_sun, to_viewer) * static_cast<double>(this_side.direct_w_m2) +
                   s.pass / kPi * static_cast<double>(other.direct_w_m2);
  return leaf_lit(hit, s, [&](const FaceLight& face) { return diffuse(face); }) +
         sun * parts_.colour.sun_tint;
}

Shader::SunAndRest Shader::leaf_parts(const RayHit& hit, const Vec3& to_viewer, double footprint_m) const {
  const Surface s = parts_.surfaces.at(hit, footprint_m);
  if (parts_.leaf_sun == LeafSun::kStored) return {leaf_sunlit_as_stored(hit, s, to_viewer), Vec3(0.0)};
  SunAndRest parts{leaf_lit(hit, s, [&](const FaceLight& face) { return diffuse(face); }), Vec3(0.0)};
  if (!parts_.light.has_beam()) return parts;
  const Vec3 to_sun = parts_.light.towards_sun({0.0, 0.0});
  parts.sun = scattering(s, to_sun, to_viewer) * cosine_factor(s, to_sun);
  if (s.is_shoot) {
    RayHit other_face = hit;
    other_face.front = !hit.front;
    parts.sun = 0.5 * (parts.sun + scattering(parts_.surfaces.at(other_face), to_sun, to_viewer));
  }
  parts.sun *= parts_.light.beam_w_m2();
  return parts;
}

Vec3 Shader::open_sun(const Vec3& normal) const {
  if (!parts_.light.has_beam()) return Vec3(0.0);
  return std::max(0.0, glm::dot(normal, parts_.light.towards_sun({0.0, 0.0}))) * parts_.light.beam_w_m2();
}

Vec3 Shader::leaf_stored(const RayHit& hit) const {
  return leaf_lit(hit, parts_.surfaces.at(hit), [&](const FaceLight& face) { return total(face); });
}

// Radiance of a leaf by what `light` takes of each face's light; of a shoot the mean of its faces.
template <class Light>
Vec3 Shader::leaf_lit(const RayHit& hit, const Surface& s, const Light& light) const {
  const ElementLight& stored = light_of(hit);
  const Vec3 mine = light(hit.front ? stored.front : stored.back);
  const Vec3 others = light(hit.front ? stored.back : stored.front);
  if (!s.is_shoot && hit.needle == RayHit::kNoNeedle) return (s.reflect * mine + s.pass * others) / kPi;
  RayHit other_face = hit;
  other_face.front = !hit.front;
  const Surface o = parts_.surfaces.at(other_face);
  return ((s.reflect + o.pass) * mine + (o.reflect + s.pass) * others) / (2.0 * kPi);
}

Vec3 Shader::irradiance(const RayHit& hit, PathSamples& numbers) const {
  const auto [sun_x, sun_y, x, y] = numbers.next();
  const Vec3 direction = trace::cosine_direction(hit.normal, x, y);
  const RayHit met = parts_.scene.closest_hit(hit.on_original_m, direction, start_from(hit, true));
  Surface white;
  white.normal = hit.normal;
  white.reflect = Vec3(1.0);
  return kPi * (gathered(met, hit.on_original_m, direction) +
                sun_scattered(hit, white, hit.normal, {sun_x, sun_y}));
}

Vec3 Shader::gathered(const RayHit& hit, const Vec3& origin_m, const Vec3& direction) const {
  if (hit.kind == HitKind::kSky) return parts_.light.sky(direction);
  if (hit.distance_m > parts_.gather_reach_m) return beyond_reach(origin_m, direction);
  if (hit.kind == HitKind::kFoliage) return leaf_stored(hit);
  if (hit.kind == HitKind::kGround) return off_ground(hit);
  return parts_.surfaces.at(hit).reflect / kPi * mean_.wood_w_m2;
}

// As if no tree stood there.
Vec3 Shader::beyond_reach(const Vec3& origin_m, const Vec3& direction) const {
  const Terrain& terrain = parts_.scene.forest().terrain;
  RayHit ground;
  ground.kind = HitKind::kGround;
  ground.front = true;
  ground.normal = terrain.normal();
  const double falls = -glm::dot(direction, ground.normal);
  if (falls <= 0.0) return parts_.light.sky(direction);
  const double height_m = ground.normal.z * (origin_m.z - terrain.height_at(origin_m.x, origin_m.y));
  ground.position_m = origin_m + std::max(0.0, height_m) / falls * direction;
  ground.on_original_m = ground.position_m;
  return off_ground(ground);
}

Vec3 Shader::off_ground(const RayHit& hit) const {
  if (!hit.front) return Vec3(0.0);
  const Vec3 light =
      parts_.scene.is_under_trees(hit.position_m) ? mean_.ground_w_m2 : parts_.light.open_ground();
  return parts_.surfaces.at(hit).reflect / kPi * light;
}

Vec3 Shader::sun_scattered(const RayHit& hit, const Surface& surface, const Vec3& to_viewer,
                           const Vec2& number) const {
  if (!parts_.light.has_beam()) return Vec3(0.0);
  const Vec3 to_sun = parts_.light.towards_sun(number);
  const double cosine = glm::dot(hit.normal, to_sun);
  const Vec3 share = scattering(surface, to_sun, to_viewer) * cosine_factor(surface, to_sun);
  if (share == Vec3(0.0) || parts_.scene.occluded(hit.on_original_m, to_sun, start_from(hit, cosine > 0.0)))
    return Vec3(0.0);
  return share * parts_.light.beam_w_m2();
}

// As sun_scattered on a leaf, whose tile says whether the sun gets there.
Vec3 Shader::sun_flecked(const RayHit& hit, const Surface& surface, const Vec3& to_viewer,
                         const Vec2& number) const {
  if (!parts_.light.has_beam() || !parts_.flecks->lit(hit, element_of(hit))) return Vec3(0.0);
  const Vec3 to_sun = parts_.light.towards_sun(number);
  return scattering(surface, to_sun, to_viewer) * cosine_factor(surface, to_sun) * parts_.light.beam_w_m2();
}

}  // namespace sunfleck
