#include "lighting/trace/probe_path.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/surface_sampler.h"

namespace sunfleck::trace {
namespace {

// Paths whose weight falls below this play Russian roulette to get back to it.
constexpr double kLightestWeight = 0.5;
// Only light caught between surfaces that absorb nothing gets this far.
constexpr int kMostBounces = 20000;

double largest_product(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, a[i] * b[i]);
  return largest;
}

bool any(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return v > 0.0; });
}

}  // namespace

double sun_facing_factor(const Illumination& light) {
  return 2.0 / (1.0 + std::cos(light.sun_half_angle_rad));
}

bool has_beam(const Illumination& light) {
  return light.sun_is_up() && std::any_of(light.bands.begin(), light.bands.end(),
                                          [](const BandLight& b) { return b.beam_normal_w_m2 > 0.0; });
}

void PathLight::clear() {
  std::ranges::fill(sky_w_m2, 0.0);
  std::ranges::fill(scattered_w_m2, 0.0);
}

void PathLight::scale(double factor) {
  for (double& w : sky_w_m2) w *= factor;
  for (double& w : scattered_w_m2) w *= factor;
}

PathTracer::PathTracer(const Forest& forest, const RayScene& rays, const OpticsTable& optics,
                       const Illumination& light)
    : forest_(forest),
      rays_(rays),
      optics_(optics),
      light_(light),
      sky_(sky_radiance(light)),
      sun_facing_(sun_facing_factor(light)),
      any_beam_(has_beam(light)),
      weight_(optics.band_count()),
      sunlight_(optics.band_count()) {
  met_.reflect.resize(optics.band_count());
  met_.pass.resize(optics.band_count());
}

// E = pi * mean radiance over cosine-distributed directions; a surface that gives back B has radiance B / pi,
// so every surface met stands for its B = r E(this side) + t E(other side), and so on from there.
void PathTracer::follow(Vec3 origin_m, Vec3 direction, RayStart from, RandomStream& random,
                        PathLight& light) {
  std::fill(weight_.begin(), weight_.end(), 1.0);
  for (int bounce = 0; bounce < kMostBounces; ++bounce) {
    const RayHit hit = rays_.closest_hit(origin_m, direction, 0.0, from);
    if (hit.kind == HitKind::kSky) {
      add_sky(direction, bounce == 0 ? light.sky_w_m2 : light.scattered_w_m2);
      return;
    }
    if (hit.kind == HitKind::kGround && !hit.front) return;  // the dark below
    if (watch_) watch_->met(hit, direction, weight_);
    look_up(hit);
    if (any_beam_) add_sun(hit, random, light.scattered_w_m2);
    if (!any(met_.reflect) && !any(met_.pass)) return;
    const bool reflected = chooses_reflection(random);
    if (!survives(random)) return;
    leave(hit, reflected, random, direction, from);
    origin_m = hit.on_original_m;
  }
}

void PathTracer::add_sky(const Vec3& direction, std::vector<double>& to) const {
  const double share = kPi * sky_.radiance(direction);
  for (std::size_t b = 0; b < to.size(); ++b)
    to[b] += weight_[b] * share * light_.bands[b].diffuse_horizontal_w_m2;
}

void PathTracer::look_up(const RayHit& hit) {
  met_.is_shoot = false;
  if (hit.kind == HitKind::kFoliage) return look_up_foliage(hit);
  std::fill(met_.pass.begin(), met_.pass.end(), 0.0);
  if (hit.kind == HitKind::kGround) {
    for (std::size_t b = 0; b < weight_.size(); ++b) met_.reflect[b] = optics_.soil_albedo(b);
    return;
  }
  const PrototypeId id = forest_.instances[hit.instance].prototype;
  const Prototype& prototype = forest_.prototypes[id.value];
  const std::size_t material = hit.kind == HitKind::kWood ? prototype.wood[hit.local].material
                                                          : prototype.wood_mesh[hit.local].material;
  for (std::size_t b = 0; b < weight_.size(); ++b)
    met_.reflect[b] = optics_.material(b, id, material).bark_reflectance;
}

void PathTracer::look_up_foliage(const RayHit& hit) {
  const PrototypeId id = forest_.instances[hit.instance].prototype;
  const FoliageElement& e = forest_.prototypes[id.value].foliage[hit.local];
  met_.is_shoot = e.shape == ElementShape::kShoot;
  for (std::size_t b = 0; b < weight_.size(); ++b) {
    const LeafOptics& leaf = optics_.material(b, id, e.material).leaf;
    met_.reflect[b] = hit.front ? leaf.reflectance_front : leaf.reflectance_back;
    met_.pass[b] = hit.front ? leaf.transmittance_back : leaf.transmittance_front;
  }
}

// Light of the sun at the point met, given back towards where the path came from.
void PathTracer::add_sun(const RayHit& hit, RandomStream& random, std::vector<double>& to) {
  const Vec3 to_sun = cone_direction(light_.to_sun, light_.sun_half_angle_rad, random);
  const double cosine = glm::dot(hit.normal, to_sun);
  const bool this_side = cosine > 0.0;
  if (!met_.is_shoot && !any(this_side ? met_.reflect : met_.pass)) return;
  const RayStart from =
      met_.is_shoot ? RayStart{} : RayStart{hit.kind, this_side == hit.front, hit.instance, hit.local};
  for (std::size_t b = 0; b < to.size(); ++b) {
    // Needles face everywhere alike: a quarter of the beam on each of their faces.
    const double given = met_.is_shoot
                             ? 0.25 * (met_.reflect[b] + met_.pass[b])
                             : sun_facing_ * std::abs(cosine) * (this_side ? met_.reflect[b] : met_.pass[b]);
    sunlight_[b] = weight_[b] * given * light_.bands[b].beam_normal_w_m2;
  }
  if (sun_is_hidden(hit, to_sun, from)) return;
  for (std::size_t b = 0; b < to.size(); ++b) to[b] += sunlight_[b];
}

bool PathTracer::sun_is_hidden(const RayHit& hit, const Vec3& to_sun, const RayStart& from) const {
  if (!watch_) return rays_.occluded(hit.on_original_m, to_sun, 0.0, from);
  const RayHit by = rays_.closest_hit(hit.on_original_m, to_sun, 0.0, from);
  if (by.kind == HitKind::kSky) return false;
  watch_->shaded(by, sunlight_);
  return true;
}

// On this side or through to the other, each with a chance in proportion to its brightest band; weighs the
// bands for it. A shoot has no sides.
bool PathTracer::chooses_reflection(RandomStream& random) {
  if (met_.is_shoot) {
    for (std::size_t b = 0; b < weight_.size(); ++b) weight_[b] *= met_.reflect[b] + met_.pass[b];
    return true;
  }
  const double reflect = largest_product(weight_, met_.reflect), pass = largest_product(weight_, met_.pass);
  const bool reflected = pass == 0.0 || random.uniform() * (reflect + pass) < reflect;
  const double chosen = reflected ? reflect : pass;
  const double chance = chosen > 0.0 ? chosen / (reflect + pass) : 1.0;
  for (std::size_t b = 0; b < weight_.size(); ++b)
    weight_[b] *= (reflected ? met_.reflect[b] : met_.pass[b]) / chance;
  return reflected;
}

bool PathTracer::survives(RandomStream& random) {
  const double heaviest = *std::max_element(weight_.begin(), weight_.end());
  if (heaviest >= kLightestWeight) return true;
  const double chance = heaviest / kLightestWeight;
  if (random.uniform() >= chance) return false;
  for (double& w : weight_) w /= chance;
  return true;
}

void PathTracer::leave(const RayHit& hit, bool reflected, RandomStream& random, Vec3& direction,
                       RayStart& from) const {
  if (met_.is_shoot) {
    direction = any_direction(random);
    from = {};
    return;
  }
  direction = cosine_direction(reflected ? hit.normal : -hit.normal, random);
  from = {hit.kind, reflected == hit.front, hit.instance, hit.local};
}

}  // namespace sunfleck::trace
