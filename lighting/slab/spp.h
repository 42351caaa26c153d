// The simplified plane-parallel model of [SPP] for a slab lit by a beam, in a form without overflow or loss
// of digits: every term is positive or mildly subtractive, nothing grows with depth.
//
// Depths are optical depths along the beam (mean numbers of leaves met): no cosine of the beam is needed, and
// a grazing sun is just a large depth. The beam's fluence at the lit boundary is 1. Diffuse light is taken as
// uniform radiance down / (2 pi) over the directions within 90 degrees of the beam's and up / (2 pi) over the
// others.
//
// [SPP] Eq. 8 gives all diffuse light the beam's cosine: against a full solution the diffuse light of a slab
// is 30 to 50 % off for an overhead beam and bright leaves. An isolated crown also loses light through its
// sides; see compensation.h.
#pragma once

namespace sunfleck {

template <class Real>
struct SlabMedium {
  Real absorption = 1;     // 1 - leaf albedo, [0, 1]; taken as given because 1 - albedo loses digits near 0
  Real backscatter = 0.5;  // R: share of scattered light that turns back, [0, 1]
  Real ground_albedo = 0;  // of the surface behind the slab, [0, 1]
};

// Fluence at a depth per fluence of the beam at the lit boundary.
template <class Real>
struct SlabLight {
  Real direct = 0;  // the beam itself, e^-depth
  Real down = 0;    // diffuse, travelling with the beam
  Real up = 0;      // diffuse, travelling against it
};

// Deeper than this is infinitely deep.
inline constexpr double kInfiniteOpticalDepth = 1e18;

// [SPP] Eq. 19 with its boundary conditions, Eq. 21 and 22, and a reflecting ground. `before` and `behind`
// are the optical depths from the point to the lit boundary and to the far one, >= 0; infinity is allowed.
// For Real = float or double: relative error of down + up below 5e-5 or 5e-14 while it is above 1e-30; of
// down alone, where it is small beside up, 3e-4 or 1e-11. Also for long double.
template <class Real>
SlabLight<Real> spp(Real before, Real behind, const SlabMedium<Real>& medium);

}  // namespace sunfleck
