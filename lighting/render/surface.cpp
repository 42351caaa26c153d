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
    : scene_(scene), look_(look) {
  const auto colours_of = [&](const MaterialOptics& m) {
    const Vec3 front = channel_factor(m.leaf.albedo_front(), colour.leaf_exponent);
    const Vec3 back = channel_factor(m.leaf.albedo_back(), colour.leaf_exponent);
    return Colours{m.leaf.reflectance_front * front, m.leaf.reflectance_back * back,
                   m.leaf.transmittance_front * front, m.leaf.transmittance_back * back,
                   m.bark_reflectance * channel_factor(m.bark_reflectance, colour.bark_exponent)};
  };
  for (std::uint32_t p = 0; p < scene.original_forest().prototypes.size(); ++p) {
    auto& row = colours_.emplace_back();
    for (std::uint32_t m = 0; m < scene.original_forest().prototypes[p].materials.size(); ++m)
      row.push_back(colours_of(optics.material(band, PrototypeId{p}, m)));
  }
  const double albedo = optics.soil_albedo(band);
  // Grass shows soil and dry blades between the green ones.
  const bool grass = look.ground == GroundCover::kGrass;
  soil_ = albedo * channel_factor(albedo, grass ? 0.5 * (colour.leaf_exponent + colour.soil_exponent)
                                                : colour.soil_exponent);
}

Surface SurfaceTable::at(const RayHit& hit, double footprint_m) const {
  if (hit.kind == HitKind::kFoliage) return leaf(hit, footprint_m);
  return hit.kind == HitKind::kGround ? ground(hit, footprint_m) : wood(hit, footprint_m);
}

Surface SurfaceTable::leaf(const RayHit& hit, double footprint_m) const {
  const PrototypeId id = scene_.original_prototype(hit.instance);
  const FoliageElement& e = scene_.shown_prototype(hit).foliage[hit.local];
  const Colours& colours = colours_[id.value][e.material];
  Surface s;
  s.normal = s.gloss_normal = hit.normal;
  s.is_shoot = e.shape == ElementShape::kShoot && hit.needle == RayHit::kNoNeedle;
  s.reflect = hit.front ? colours.reflect_front : colours.reflect_back;
  s.pass = hit.front ? colours.pass_back : colours.pass_front;
  if (scene_.has_outline(hit)) {
    const MaterialLook& look = scene_.look_of(id, e.material);
    const double length_m =
        2.0 * scene_.forest().instances[hit.instance].scale * static_cast<double>(glm::length(e.half_u_m));
    const double left = footprint_m > 0.0 ? look.leaf_pattern_left(footprint_m / length_m) : 1.0;
    const bool bumps = hit.front && look.has_normals();
    const Vec2 at = left > 0.0 || bumps ? scene_.leaf_place(hit) : Vec2(0.0);
    if (left > 0.0) {
      s.reflect *= 1.0 + left * (look.leaf_reflect(at) - 1.0);
      s.pass *= 1.0 + left * (look.leaf_pass(at) - 1.0);
      keep_energy(s);
    }
    if (bumps) {
      const Basis axes = scene_.leaf_axes(hit);
      const Vec3 n = look.leaf_normal(at);
      s.gloss_normal = glm::normalize(n.x * axes.tangent + n.y * axes.bitangent + n.z * hit.normal);
    }
  }
  if (hit.front && !s.is_shoot) s.gloss = look_.leaf_gloss;
  s.gloss_exponent = look_.gloss_exponent;
  return s;
}

Surface SurfaceTable::wood(const RayHit& hit, double footprint_m) const {
  const PrototypeId id = scene_.original_prototype(hit.instance);
  const Prototype& prototype = scene_.shown_prototype(hit);
  const std::uint32_t material = hit.kind == HitKind::kWood ? prototype.wood[hit.local].material
                                                            : prototype.wood_mesh[hit.local].material;
  Surface s;
  s.normal = hit.normal;
  s.reflect = colours_[id.value][material].bark *
              scene_.look_of(id, material).bark(scene_.bark_place(hit), footprint_m);
  keep_energy(s);
  return s;
}

Surface SurfaceTable::ground(const RayHit& hit, double footprint_m) const {
  Surface s;
  s.normal = hit.normal;
  s.reflect = soil_;
  if (look_.patterns) s.reflect *= litter_pattern({hit.position_m.x, hit.position_m.y}, footprint_m);
  keep_energy(s);
  return s;
}

}  // namespace sunfleck
