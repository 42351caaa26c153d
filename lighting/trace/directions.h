// Directions by their densities, from random numbers or from points of the unit square.
#pragma once

#include "sim/base/random.h"
#include "sim/base/vec.h"

namespace sunfleck::trace {

// Density cos / pi around the unit vector `normal`, never along the surface itself.
Vec3 cosine_direction(const Vec3& normal, RandomStream& random);
// The same from two numbers in [0, 1): what is spread evenly over the square is spread evenly over the view.
Vec3 cosine_direction(const Vec3& normal, double a, double b);
// Even within `half_angle` of the unit vector `axis`.
Vec3 cone_direction(const Vec3& axis, double half_angle_rad, RandomStream& random);
Vec3 cone_direction(const Vec3& axis, double half_angle_rad, double a, double b);
// Even over the sphere.
Vec3 any_direction(RandomStream& random);
Vec3 any_direction(double a, double b);

// A point of the unit disc for one of the unit square, areas and neighbourhoods kept (Shirley and Chiu 1997,
// "A low distortion map between disk and square").
Vec2 on_disc(double a, double b);

}  // namespace sunfleck::trace
