#include "lighting/render/surface.h"

#include <algorithm>
#include <cmath>

namespace sunfleck {
namespace {

// What reflects more than it gets for a pattern's sake is brought back to it.
void keep_energy(Surface& s) {
  for (int c = 0; c < 3; ++c) {
    const double both = s.reflect[c] + s.pass[c];
    if (both > 1.0) s.reflect[c] /= both, s.pass[c] /= both;
  }
}

}  // namespace

// Modified Phong lobe of Lafortune and Willems 1994: (n + 2) / (2 pi) cos^n to the mirror direction; it
// reflects all at normal incidence and less at grazing, never more.
Vec3 scattering(const Surface& s, const Vec3& from_light, const Vec3& to_viewer) {
  if (s.is_shoot) return (s.reflect + s.pass) / (4.0 * kPi);
  if (glm::dot(from_light, s.normal) <= 0.0) return s.pass / kPi;
  Vec3 share((1.0 - s.gloss) / kPi);
  if (s.gloss > 0.0) {
    const Vec3 mirror = 2.0 * glm::dot(to_viewer, s.gloss_normal) * s.gloss_normal - to_viewer;
    const double cosine = std::max(0.0, glm::dot(mirror, from_light));
    share += s.gloss * (s.gloss_exponent + 2.0) / (2.0 * kPi) * std::pow(cosine, s.gloss_exponent);
  }
  return s.reflect * share;
}

double cosine_factor(const Surface& s, const Vec3& direction) {
  return s.is_shoot ? 1.0 : std::abs(glm::dot(s.normal, direction));
}

SurfaceTable::SurfaceTable(const PictureScene& scene, const OpticsTable& optics, std::size_t band,
                           const PictureColour& colour, const PictureLook& look)
    : scene_(scene), optics_(optics), band_(band), colour_(colour), look_(look) {}

Surface SurfaceTable::at(const RayHit& hit) const {
  if (hit.kind == HitKind::kFoliage) return leaf(hit);
  return hit.kind == HitKind::kGround ? ground(hit) : wood(hit);
}

Surface SurfaceTable::leaf(const RayHit& hit) const {
  const PrototypeId id = scene_.original_prototype(hit.instance);
  const FoliageElement& e = scene_.shown_prototype(hit).foliage[hit.local];
  const LeafOptics& leaf = optics_.material(band_, id, e.material).leaf;
  const Vec3 front = channel_factor(leaf.albedo_front(), colour_.leaf_exponent);
  const Vec3 back = channel_factor(leaf.albedo_back(), colour_.leaf_exponent);
  Surface s;
  s.normal = s.gloss_normal = hit.normal;
  s.is_shoot = e.shape == ElementShape::kShoot && hit.needle == RayHit::kNoNeedle;
  s.reflect = hit.front ? leaf.reflectance_front * front : leaf.reflectance_back * back;
  s.pass = hit.front ? leaf.transmittance_back * back : leaf.transmittance_front * front;
  if (scene_.has_outline(hit)) {
    const MaterialLook& look = scene_.look_of(id, e.material);
    const Vec2 at = scene_.leaf_place(hit);
    s.reflect *= look.leaf_reflect(at);
    s.pass *= look.leaf_pass(at);
    keep_energy(s);
    if (hit.front && look.has_normals()) {
      const Basis axes = scene_.leaf_axes(hit);
      const Vec3 n = look.leaf_normal(at);
      s.gloss_normal = glm::normalize(n.x * axes.tangent + n.y * axes.bitangent + n.z * hit.normal);
    }
  }
  if (hit.front && !s.is_shoot) s.gloss = look_.leaf_gloss;
  s.gloss_exponent = look_.gloss_exponent;
  return s;
}

Surface SurfaceTable::wood(const RayHit& hit) const {
  const PrototypeId id = scene_.original_prototype(hit.instance);
  const Prototype& prototype = scene_.shown_prototype(hit);
  const std::uint32_t material = hit.kind == HitKind::kWood ? prototype.wood[hit.local].material
                                                            : prototype.wood_mesh[hit.local].material;
  const double albedo = optics_.material(band_, id, material).bark_reflectance;
  Surface s;
  s.normal = hit.normal;
  s.reflect = albedo * channel_factor(albedo, colour_.bark_exponent) *
              scene_.look_of(id, material).bark(scene_.bark_place(hit));
  keep_energy(s);
  return s;
}

Surface SurfaceTable::ground(const RayHit& hit) const {
  const double albedo = optics_.soil_albedo(band_);
  Surface s;
  s.normal = hit.normal;
  const bool grass = look_.ground == GroundCover::kGrass;
  // Grass shows soil and dry blades between the green ones.
  const Vec3 exponent = grass ? 0.5 * (colour_.leaf_exponent + colour_.soil_exponent) : colour_.soil_exponent;
  s.reflect = albedo * channel_factor(albedo, exponent);
  if (look_.patterns) s.reflect *= litter_pattern({hit.position_m.x, hit.position_m.y});
  keep_energy(s);
  return s;
}

}  // namespace sunfleck
