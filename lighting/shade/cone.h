// Light off one whorl of needles: level 2 of the pine shaders of [Meyer00]. Needles of one length start at
// the apex (the origin) and lie evenly on a cone that opens towards +z. For baking and as reference; at run
// time boughs (bough.h) stand for many cones.
//
// The printed form adds the needles up as if none hid another: 25 % too much cover on average for the paper's
// own cone. cone_light corrects for needles that overlap near the apex (local cover of the cone's surface
// saturates at 1) and for the rear half that shows through the front half: 1.5 % (3.2 % at most).
//
// Directions are unit vectors in the cone's frame, away from the needles; lengths in one unit, areas in its
// square. Reflected: integral over the covered area of max(N.L, 0); radiance = albedo / pi * irradiance
// across the light * reflected / footprint.
#pragma once

#include "sim/base/vec.h"

namespace sunfleck {

struct NeedleCone {
  int needles = 12;
  double length = 1, radius = 0.01;  // of a needle
  double aperture_rad = kPi / 8;     // between axis and needle, (0, pi/2)
};
// Throws Error(kInvalidInput) that names `where` for values out of range.
void validate(const NeedleCone& cone, const char* where);

struct ConeLight {
  double covered = 0;    // projected area that hides what is behind: opacity = covered / footprint
  double reflected = 0;  // seen and lit, shadows of the cone on itself included
};

// With overlap and saturation. Never negative; covered <= projected area of the cone's surface.
ConeLight cone_light(const NeedleCone& cone, const Vec3& to_viewer, const Vec3& to_light);

// As printed ([Meyer00] Eqs. 4 and 6, integrated by arc_series.h): needles added up, nothing hidden or
// shaded. The front part (outer side towards the viewer) and the rear part apart.
struct LinearConeLight {
  ConeLight front, rear;
};
LinearConeLight cone_light_linear(const NeedleCone& cone, const Vec3& to_viewer, const Vec3& to_light);

// Half the azimuth range, round that of `direction`, whose outer side is turned towards it; [0, pi].
double front_half_angle_rad(double aperture_rad, double direction_zenith_rad);

}  // namespace sunfleck
