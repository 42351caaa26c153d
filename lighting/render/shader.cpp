#include "lighting/render/shader.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

constexpr char kPar[] = "PAR";

std::size_t picture_band(const OpticsTable& optics) {
  const auto& bands = optics.bands();
  const auto par = std::find(bands.begin(), bands.end(), kPar);
  return par == bands.end() ? 0 : static_cast<std::size_t>(par - bands.begin());
}

// Rays leave a surface a little above it, more where the hit is farther and its position rounder.
double lift_m(const RayHit& hit) { return 1e-4 + 1e-6 * hit.distance_m; }
Vec3 lifted(const RayHit& hit) { return hit.position_m + lift_m(hit) * hit.normal; }

// Cosine-distributed, the i-th of kGatherRays: one from each cell of a square of strata.
Vec3 cosine_direction(const Vec3& normal, int i, RandomStream& random) {
  const double u = (i % kGatherSide + random.uniform()) / kGatherSide;
  const double v = (i / kGatherSide + random.uniform()) / kGatherSide;
  const double sine = std::sqrt(u), azimuth_rad = 2.0 * kPi * v;
  const Basis basis = basis_around(normal);
  return sine * std::cos(azimuth_rad) * basis.tangent + sine * std::sin(azimuth_rad) * basis.bitangent +
         std::sqrt(1.0 - u) * normal;
}

// A point of the sun's disc, evenly in solid angle; its centre where it has no size.
Vec3 towards_sun(const Illumination& light, RandomStream& random) {
  const double u = random.uniform(), azimuth_rad = 2.0 * kPi * random.uniform();
  if (light.sun_half_angle_rad == 0.0) return light.to_sun;
  const double versine = 2.0 * std::pow(std::sin(0.5 * light.sun_half_angle_rad), 2);  // 1 - cos
  const double cosine = 1.0 - u * versine, sine = std::sqrt(u * versine * (1.0 + cosine));
  const Basis basis = basis_around(light.to_sun);
  return sine * std::cos(azimuth_rad) * basis.tangent + sine * std::sin(azimuth_rad) * basis.bitangent +
         cosine * light.to_sun;
}

}  // namespace

Shader::Shader(const Forest& forest, const ForestIndex& index, const OpticsTable& optics, const LightMap& map,
               const Illumination& light, const RayScene& scene)
    : forest_(forest),
      index_(index),
      optics_(optics),
      map_(map),
      light_(light),
      sky_(sky_radiance(light)),
      scene_(scene),
      band_(picture_band(optics)),
      colour_(picture_colour(optics.bands()[band_] == kPar ? PictureBand::kPar : PictureBand::kOther, light,
                             band_)) {}

Vec3 Shader::radiance(const RayHit& hit, const Vec3& direction, RandomStream& random) const {
  switch (hit.kind) {
    case HitKind::kSky:
      return background(direction);
    case HitKind::kFoliage:
      return leaf(hit);
    case HitKind::kWood:
    case HitKind::kWoodMesh:
      return opaque(hit, bark_albedo(hit), colour_.bark_exponent, random);
    case HitKind::kGround:
      break;
  }
  return opaque(hit, optics_.soil_albedo(band_), colour_.soil_exponent, random);
}

std::size_t Shader::element_of(const RayHit& hit) const {
  return index_.first_element(hit.instance) + hit.local;
}

Vec3 Shader::channels(const FaceLight& face) const {
  return static_cast<double>(face.direct_w_m2) * colour_.sun_tint +
         static_cast<double>(face.sky_w_m2) * colour_.sky_tint + Vec3(face.scattered_w_m2);
}

Vec3 Shader::leaf(const RayHit& hit) const {
  const PrototypeId prototype = forest_.instances[hit.instance].prototype;
  const FoliageElement& element = forest_.prototypes[prototype.value].foliage[hit.local];
  const LeafOptics& optics = optics_.material(band_, prototype, element.material).leaf;
  const ElementLight& light = map_.bands[band_].elements[element_of(hit)];
  const Vec3 front = channels(light.front), back = channels(light.back);
  const Vec3 from_front =
      channel_factor(optics.albedo_front(), colour_.leaf_exponent) * optics.reflectance_front * front +
      channel_factor(optics.albedo_back(), colour_.leaf_exponent) * optics.transmittance_back * back;
  const Vec3 from_back =
      channel_factor(optics.albedo_back(), colour_.leaf_exponent) * optics.reflectance_back * back +
      channel_factor(optics.albedo_front(), colour_.leaf_exponent) * optics.transmittance_front * front;
  if (element.shape == ElementShape::kShoot) return (from_front + from_back) / (2.0 * kPi);
  return (hit.front ? from_front : from_back) / kPi;
}

Vec3 Shader::opaque(const RayHit& hit, double albedo, const Vec3& exponent, RandomStream& random) const {
  Vec3 irradiance = sun_irradiance(hit, random);
  for (int i = 0; i < kGatherRays; ++i) {
    const Vec3 direction = cosine_direction(hit.normal, i, random);
    irradiance += gathered(scene_.closest_hit(lifted(hit), direction), direction) * (kPi / kGatherRays);
  }
  return channel_factor(albedo, exponent) * (albedo / kPi) * irradiance;
}

Vec3 Shader::gathered(const RayHit& hit, const Vec3& direction) const {
  switch (hit.kind) {
    case HitKind::kSky:
      return sky(direction);
    case HitKind::kFoliage:
      return leaf(hit);
    case HitKind::kWood:
    case HitKind::kWoodMesh:
      return in_the_open(hit, bark_albedo(hit), colour_.bark_exponent);
    case HitKind::kGround:
      break;
  }
  return in_the_open(hit, optics_.soil_albedo(band_), colour_.soil_exponent);
}

// Lit by the whole sky and the sun with nothing in the way.
Vec3 Shader::in_the_open(const RayHit& hit, double albedo, const Vec3& exponent) const {
  const BandLight& light = light_.bands[band_];
  const double sun_cosine = light_.sun_is_up() ? std::max(0.0, glm::dot(hit.normal, light_.to_sun)) : 0.0;
  const Vec3 irradiance = light.beam_normal_w_m2 * sun_cosine * colour_.sun_tint +
                          light.diffuse_horizontal_w_m2 * colour_.sky_tint;
  return channel_factor(albedo, exponent) * (albedo / kPi) * irradiance;
}

Vec3 Shader::sun_irradiance(const RayHit& hit, RandomStream& random) const {
  const double beam_w_m2 = light_.bands[band_].beam_normal_w_m2;
  if (!light_.sun_is_up() || beam_w_m2 == 0.0) return Vec3(0.0);
  const Vec3 to_sun = towards_sun(light_, random);
  const double cosine = glm::dot(hit.normal, to_sun);
  if (cosine <= 0.0 || scene_.occluded(lifted(hit), to_sun)) return Vec3(0.0);
  return beam_w_m2 * cosine * colour_.sun_tint;
}

Vec3 Shader::sky(const Vec3& direction) const {
  return light_.bands[band_].diffuse_horizontal_w_m2 * sky_.radiance(direction) * colour_.sky_tint;
}

// Below the horizon and past the edge of falling ground, the picture goes on with the sky of the horizon.
Vec3 Shader::background(const Vec3& direction) const {
  const Vec3 seen = sky({direction.x, direction.y, std::max(direction.z, 1e-9)});
  const double half_angle_rad = light_.sun_half_angle_rad;
  if (!light_.sun_is_up() || half_angle_rad == 0.0) return seen;
  // The chord to the sun's centre tells the angle without loss near 0.
  if (glm::length(direction - light_.to_sun) > 2.0 * std::sin(0.5 * half_angle_rad)) return seen;
  const double projected_sr = kPi * std::pow(std::sin(half_angle_rad), 2);
  return seen + light_.bands[band_].beam_normal_w_m2 / projected_sr * colour_.sun_tint;
}

double Shader::bark_albedo(const RayHit& hit) const {
  const PrototypeId id = forest_.instances[hit.instance].prototype;
  const Prototype& prototype = forest_.prototypes[id.value];
  const std::uint32_t material = hit.kind == HitKind::kWood ? prototype.wood[hit.local].material
                                                            : prototype.wood_mesh[hit.local].material;
  return optics_.material(band_, id, material).bark_reflectance;
}

}  // namespace sunfleck
