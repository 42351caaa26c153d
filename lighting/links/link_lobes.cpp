#include "lighting/links/link_lobes.h"

#include <algorithm>
#include <cmath>

namespace sunfleck::links {
namespace {

constexpr double kUpShare = 0.5;       // of the links
constexpr int kFewestForMore = 8;      // links of a lobe that more rays than these are cast for
constexpr double kLeastWeight = 1e-6;  // of a lobe that gets a ray

// Rays for the first of two lobes that share `rays`, in proportion to their weights.
int first_of(int rays, double weight) {
  const int least = weight > kLeastWeight ? 1 : 0, most = rays - (1.0 - weight > kLeastWeight ? 1 : 0);
  return std::clamp(static_cast<int>(std::lround(rays * weight)), least, most);
}

int cast_above(int links) { return links < kFewestForMore ? links : 2 * links; }

struct DiscPoint {
  double x, y;
};

// Even over the unit disc (Shirley and Chiu 1997, "A low distortion map between disk and square").
DiscPoint on_disc(double a, double b) {
  const double x = 2.0 * a - 1.0, y = 2.0 * b - 1.0;
  if (x == 0.0 && y == 0.0) return {0.0, 0.0};
  const bool wide = std::abs(x) > std::abs(y);
  const double radius = wide ? x : y, turn = wide ? 0.25 * kPi * (y / x) : 0.5 * kPi - 0.25 * kPi * (x / y);
  return {radius * std::cos(turn), radius * std::sin(turn)};
}

// Cosine-distributed directions are even points of the unit disc in the plane of the face (Nusselt). With x
// uphill the horizon crosses it at x = -n_z sqrt(1 - y^2): each chord is squeezed into its part.
double squeezed(const DiscPoint& p, Part part, double normal_z) {
  if (part == Part::kWhole) return p.x;
  const double chord = std::sqrt(std::max(0.0, 1.0 - p.y * p.y));
  const double up = 0.5 * (1.0 + normal_z), down = 0.5 * (1.0 - normal_z);
  return part == Part::kUp ? up * p.x + down * chord : down * p.x - up * chord;
}

}  // namespace

Lobes leaf_lobes(int links_per_face, double normal_z) {
  const int all = 2 * links_per_face, up = static_cast<int>(std::lround(kUpShare * all)), down = all - up;
  const double front_up = std::clamp(0.5 * (1.0 + normal_z), 0.0, 1.0);
  const int front_up_rays = first_of(up, front_up), back_down_rays = first_of(down, front_up);
  Lobes lobes;
  lobes[kFrontUp] = {front_up_rays, cast_above(front_up_rays), front_up};
  lobes[kBackUp] = {up - front_up_rays, cast_above(up - front_up_rays), 1.0 - front_up};
  lobes[kBackDown] = {back_down_rays, back_down_rays, front_up};
  lobes[kFrontDown] = {down - back_down_rays, down - back_down_rays, 1.0 - front_up};
  // A lobe too thin for a ray leaves its weight to the other one of its face.
  for (const auto& [thin, other] :
       {std::array{kFrontUp, kFrontDown}, {kFrontDown, kFrontUp}, {kBackUp, kBackDown}, {kBackDown, kBackUp}})
    if (lobes[thin].links == 0) lobes[other].weight = 1.0, lobes[thin].weight = 0.0;
  return lobes;
}

Lobes whole_lobes(int links_per_face) {
  Lobes lobes;
  lobes[kFrontUp] = lobes[kBackUp] = {links_per_face, links_per_face, 1.0};
  return lobes;
}

Vec3 cosine_direction(const Vec3& normal, Part part, double a, double b) {
  const Vec3 rise = Vec3(0, 0, 1) - normal.z * normal;
  const double steep = glm::length(rise);
  const Vec3 uphill = steep > 1e-9 ? rise / steep : basis_around(normal).tangent;
  const DiscPoint p = on_disc(a, b);
  const double x = squeezed(p, part, normal.z);
  // Never along the face itself.
  const double up = std::sqrt(std::max(1e-16, 1.0 - x * x - p.y * p.y));
  return glm::normalize(x * uphill + p.y * glm::cross(normal, uphill) + up * normal);
}

Vec3 even_direction(Part part, double a, double b) {
  const double turn = 2.0 * kPi * b;
  const double z = part == Part::kWhole ? 2.0 * a - 1.0 : part == Part::kUp ? 1.0 - a : a - 1.0;
  const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {across * std::cos(turn), across * std::sin(turn), z};
}

}  // namespace sunfleck::links
