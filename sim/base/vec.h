// Vectors, boxes and the frame everything is in.
//
// Frame: right-handed, x east, y north, z up, metres. Azimuth is measured clockwise from north, zenith from
// +z. A direction "to_sun" points from the scene to the sun.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>

namespace sunfleck {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec3f = glm::vec3;

inline constexpr double kPi = std::numbers::pi;
constexpr double radians_from_degrees(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees_from_radians(double radians) { return radians * (180.0 / kPi); }

// Unit vector towards (azimuth clockwise from north, zenith from +z), both in radians.
Vec3 direction_from_azimuth_zenith(double azimuth_rad, double zenith_rad);
// Azimuth in [0, 2 pi) and zenith in [0, pi] of a unit vector.
double azimuth_of(const Vec3& direction);
double zenith_of(const Vec3& direction);

// Two unit vectors that complete `normal` (unit) to a right-handed frame (tangent, bitangent, normal);
// continuous but for the direction -z. Duff et al. 2017, "Building an orthonormal basis, revisited".
struct Basis {
  Vec3 tangent, bitangent;
};
Basis basis_around(const Vec3& normal);

// True if every component is finite.
bool is_finite(const Vec3& v);

// Axis-aligned box; empty until it includes a point.
struct Box {
  Vec3 lo{std::numeric_limits<double>::infinity()};
  Vec3 hi{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  Vec3 centre() const { return 0.5 * (lo + hi); }
  Vec3 size() const { return empty() ? Vec3(0.0) : hi - lo; }
  void include(const Vec3& p);
  void include(const Box& other);
};

}  // namespace sunfleck
