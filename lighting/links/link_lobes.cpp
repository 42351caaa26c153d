#include "lighting/links/link_lobes.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/directions.h"

namespace sunfleck::links {
namespace {

constexpr double kUpShare = 0.5;  // of the links
constexpr int kCastPerLinkAbove = 3, kCastPerLinkOfShootAbove = 4;
constexpr double kLeastWeight = 1e-6;  // of a lobe that gets a ray

// Cosine-distributed directions are even points of the unit disc in the plane of the face (Nusselt). With x
// uphill the horizon crosses it at x = -n_z c on every chord of half length c = sqrt(1 - y^2).
struct LeafPlane {
  LeafPlane(const Vec3& normal) : normal_(normal) {
    const Vec3 rise = Vec3(0, 0, 1) - normal.z * normal;
    const double steep = glm::length(rise);
    uphill_ = steep > 1e-9 ? rise / steep : basis_around(normal).tangent;
    aside_ = glm::cross(normal, uphill_);
  }
  // Never along the face itself.
  Vec3 direction(double x, double y, bool front) const {
    const double up = std::sqrt(std::max(1e-16, 1.0 - x * x - y * y));
    return glm::normalize(x * uphill_ + y * aside_ + (front ? up : -up) * normal_);
  }

 private:
  Vec3 normal_, uphill_, aside_;
};

double half_chord(double y) { return std::sqrt(std::max(0.0, 1.0 - y * y)); }

double share_above(double normal_z) { return std::clamp(0.5 * (1.0 + normal_z), 0.0, 1.0); }

}  // namespace

HalfCounts counts_of(Half half, bool is_shoot, int links_per_face) {
  const int all = 2 * links_per_face, up = static_cast<int>(std::lround(kUpShare * all));
  if (half == Half::kDown) return {all - up, all - up};
  return {up, (is_shoot ? kCastPerLinkOfShootAbove : kCastPerLinkAbove) * up};
}

double lobe_weight(Lobe lobe, double normal_z) {
  const double weight = share_above(lobe == kFrontUp || lobe == kBackDown ? normal_z : -normal_z);
  if (weight < kLeastWeight) return 0.0;
  return weight > 1.0 - kLeastWeight ? 1.0 : weight;
}

// A chord of the disc, from the front's horizon up over the rim to the back's horizon, or down.
LeafDirection leaf_direction(const Vec3& normal, Half half, double a, double b) {
  const Vec2 p = trace::on_disc(a, b);
  const double c = half_chord(p.y), horizon = normal.z * c;
  const LeafPlane plane(normal);
  if (half == Half::kUp) {
    const bool front = p.x < horizon;
    return {plane.direction(front ? p.x + c - horizon : c + horizon - p.x, p.y, front), front};
  }
  const bool front = p.x >= horizon;
  return {plane.direction(front ? p.x - horizon - c : horizon - p.x - c, p.y, front), front};
}

// Each chord is squeezed into its half.
Vec3 lobe_direction(const Vec3& normal, Half half, double a, double b) {
  const Vec2 p = trace::on_disc(a, b);
  const double c = half_chord(p.y), up = share_above(normal.z), down = 1.0 - up;
  const double x = half == Half::kUp ? up * p.x + down * c : down * p.x - up * c;
  return LeafPlane(normal).direction(x, p.y, true);
}

Vec3 even_direction(Half half, double a, double b) {
  const Vec3 d = trace::any_direction(0.5 * (1.0 + a), b);
  return half == Half::kUp ? d : Vec3(d.x, d.y, -d.z);
}

}  // namespace sunfleck::links
