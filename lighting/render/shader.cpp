#include "lighting/render/shader.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/surface_sampler.h"

namespace sunfleck {
namespace {

RayStart leaving(const RayHit& hit, bool this_side = true) {
  return {hit.kind, this_side == hit.front, hit.instance, hit.local};
}

Vec2 stratum(int i, RandomStream& random) {
  const double x = random.uniform(), y = random.uniform();
  return Vec2(i % kGatherSide + x, i / kGatherSide + y) / static_cast<double>(kGatherSide);
}

}  // namespace

Vec3 Shader::radiance(const RayHit& hit, const Vec3& direction, RandomStream& random) const {
  if (hit.kind == HitKind::kSky) return parts_.light.background(direction);
  if (hit.kind == HitKind::kGround && !hit.front) return Vec3(0.0);  // the dark below
  return hit.kind == HitKind::kFoliage ? leaf_seen(hit, -direction, random)
                                       : parts_.surfaces.at(hit).reflect / kPi * irradiance(hit, random);
}

std::size_t Shader::element_of(const RayHit& hit) const {
  return parts_.index.first_element(hit.instance) + hit.local;
}

const ElementLight& Shader::light_of(const RayHit& hit) const { return parts_.map.elements[element_of(hit)]; }

Vec3 Shader::diffuse(const FaceLight& face) const {
  return static_cast<double>(face.sky_w_m2) * parts_.colour.sky_tint +
         static_cast<double>(face.scattered_w_m2) * mean_.scatter_tint;
}

Vec3 Shader::total(const FaceLight& face) const {
  return static_cast<double>(face.direct_w_m2) * parts_.colour.sun_tint + diffuse(face);
}

Vec3 Shader::leaf_seen(const RayHit& hit, const Vec3& to_viewer, RandomStream& random) const {
  const Surface s = parts_.surfaces.at(hit);
  if (s.is_shoot) return shoot_stored(hit);
  if (parts_.leaf_sun == LeafSun::kStored && s.gloss == 0.0) return leaf_stored(hit);
  const ElementLight& light = light_of(hit);
  const FaceLight &this_side = hit.front ? light.front : light.back,
                  &other = hit.front ? light.back : light.front;
  const Vec3 seen = (s.reflect * diffuse(this_side) + s.pass * diffuse(other)) / kPi;
  if (parts_.leaf_sun == LeafSun::kTraced) return seen + sun_scattered(hit, s, to_viewer, random);
  // Stored sunlight with its gloss: as if it came from the middle of the disc.
  const Vec3 to_sun = parts_.light.towards_sun({0.0, 0.0});
  return seen + (scattering(s, to_sun, to_viewer) * static_cast<double>(this_side.direct_w_m2) +
                 s.pass / kPi * static_cast<double>(other.direct_w_m2)) *
                    parts_.colour.sun_tint;
}

Vec3 Shader::leaf_stored(const RayHit& hit) const {
  const Surface s = parts_.surfaces.at(hit);
  if (s.is_shoot) return shoot_stored(hit);
  const ElementLight& light = light_of(hit);
  const Vec3 front = total(light.front), back = total(light.back);
  return (s.reflect * (hit.front ? front : back) + s.pass * (hit.front ? back : front)) / kPi;
}

Vec3 Shader::shoot_stored(const RayHit& hit) const {
  const ElementLight& light = light_of(hit);
  RayHit other_face = hit;
  other_face.front = !hit.front;
  const Surface s = parts_.surfaces.at(hit), o = parts_.surfaces.at(other_face);
  const Vec3 mine = total(hit.front ? light.front : light.back);
  const Vec3 others = total(hit.front ? light.back : light.front);
  return ((s.reflect + o.pass) * mine + (o.reflect + s.pass) * others) / (2.0 * kPi);
}

Vec3 Shader::irradiance(const RayHit& hit, RandomStream& random) const {
  Vec3 sum(0.0);
  for (int i = 0; i < kGatherRays; ++i) {
    const Vec2 number = stratum(i, random);
    const Vec3 direction = trace::cosine_direction(hit.normal, number.x, number.y);
    sum += gathered(parts_.scene.closest_hit(hit.on_original_m, direction, leaving(hit)), direction);
  }
  Surface white;
  white.normal = hit.normal;
  white.reflect = Vec3(1.0);
  return kPi / kGatherRays * sum + kPi * sun_scattered(hit, white, hit.normal, random);
}

Vec3 Shader::gathered(const RayHit& hit, const Vec3& direction) const {
  if (hit.kind == HitKind::kSky) return parts_.light.sky(direction);
  if (hit.kind == HitKind::kFoliage) return leaf_stored(hit);
  if (hit.kind != HitKind::kGround) return parts_.surfaces.at(hit).reflect / kPi * mean_.wood_w_m2;
  if (!hit.front) return Vec3(0.0);
  const Vec3 light =
      parts_.scene.is_under_trees(hit.position_m) ? mean_.ground_w_m2 : parts_.light.open_ground();
  return parts_.surfaces.at(hit).reflect / kPi * light;
}

Vec3 Shader::sun_scattered(const RayHit& hit, const Surface& surface, const Vec3& to_viewer,
                           RandomStream& random) const {
  if (!parts_.light.has_beam()) return Vec3(0.0);
  const double x = random.uniform(), y = random.uniform();
  const Vec3 to_sun = parts_.light.towards_sun({x, y});
  const double cosine = glm::dot(hit.normal, to_sun);
  const Vec3 share = scattering(surface, to_sun, to_viewer) * std::abs(cosine);
  if (share == Vec3(0.0) || parts_.scene.occluded(hit.on_original_m, to_sun, leaving(hit, cosine > 0.0)))
    return Vec3(0.0);
  return share * parts_.light.beam_w_m2();
}

}  // namespace sunfleck
