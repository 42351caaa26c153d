// Light off one needle: level 1 of the pine shaders of [Meyer00], a thin opaque Lambertian cylinder of axis a
// under parallel light, seen from far away.
//
// Conventions: V (to_viewer) and L (to_light) are unit vectors away from the surface, the axis is a unit
// vector of either sign. Reflectances are means over the apparent rectangle (2 radius x length x sin(a, V))
// of max(N.L, 0), N.V > 0: radiance = albedo / pi * irradiance across the light * diffuse. Single scattering:
// no light from other needles. Valid for length >> radius (ends are left out). Seen or lit along the axis the
// azimuth is undefined; then the value is that of light and viewer a quarter turn apart, times its sine.
//
// All templates work in double and float (float within 2e-6 of double).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "lighting/shade/needle_frame.h"

namespace sunfleck {

// What the diffuse form needs to know of the three directions.
template <class Real>
struct NeedleAngles {
  Real sin_view = 0;     // of the angle between axis and V, s_v
  Real sin_light = 0;    // s_l
  Real cos_between = 0;  // cos psi, psi = azimuth between V and L round the axis
};

template <class Real>
NeedleAngles<Real> needle_angles(const glm::vec<3, Real>& axis, const glm::vec<3, Real>& to_viewer,
                                 const glm::vec<3, Real>& to_light) {
  const Real cos_view = glm::dot(axis, to_viewer), cos_light = glm::dot(axis, to_light);
  const Real sin2_view = std::max(Real(0), 1 - cos_view * cos_view);
  const Real sin2_light = std::max(Real(0), 1 - cos_light * cos_light);
  const Real product = std::sqrt(sin2_view * sin2_light);
  const Real cosine =
      product > 0 ? (glm::dot(to_viewer, to_light) - cos_view * cos_light) / product : Real(0);
  return {std::sqrt(sin2_view), std::sqrt(sin2_light), std::clamp(cosine, Real(-1), Real(1))};
}

// Rd = s_l / 4 ((pi - psi) cos psi + sin psi), exact ([Meyer00] Eq. 1).
template <class Real>
Real needle_diffuse(const NeedleAngles<Real>& angles) {
  const Real c = angles.cos_between;
  const Real rest = std::acos(-c);  // pi - psi
  return std::max(Real(0), angles.sin_light / 4 * (rest * c + std::sqrt(std::max(Real(0), 1 - c * c))));
}

// The same without acos: the bracket as 1 + pi/2 c + (pi/2 - 1) c^2, which has its values at psi = 0, pi/2,
// pi and its slopes at both ends ([Meyer00] section 5, "maximum error less than 1 %").
template <class Real>
Real needle_diffuse_quick(const NeedleAngles<Real>& angles) {
  constexpr Real half_pi = std::numbers::pi_v<Real> / 2;
  const Real c = angles.cos_between;
  return angles.sin_light / 4 * (1 + c * (half_pi + c * (half_pi - 1)));
}
// Largest |needle_diffuse_quick - needle_diffuse|: 0.0237 of the bracket, a quarter of it.
inline constexpr double kQuickDiffuseError = 0.0237 / 4;

// Blinn highlight cos^n(N.H) without an N.L factor, mean over the apparent rectangle, as printed ([Meyer00]
// Eq. 2, cos^n x taken as a Gaussian inside the seen and lit arc): s_h^n sqrt(pi / 2n) max(0, cos(V, H)).
// Wrong by up to 0.15 (n = 20) or 0.03 (n = 100) where H leaves that arc.
template <class Real>
Real needle_specular_printed(const glm::vec<3, Real>& axis, const glm::vec<3, Real>& to_viewer,
                             const glm::vec<3, Real>& to_light, Real exponent) {
  const HighlightFrame<Real> frame = highlight_frame(axis, to_viewer, to_light);
  const Real width = std::sqrt(std::numbers::pi_v<Real> / (2 * exponent));
  return std::pow(frame.sin_half, exponent) * width * std::max(Real(0), std::cos(frame.view_from_half_rad));
}

// The same with the Gaussian cut off at the ends of the arc that is seen and lit: within 0.017 (n = 20),
// 0.004 (50), 0.002 (100).
template <class Real>
Real needle_specular(const glm::vec<3, Real>& axis, const glm::vec<3, Real>& to_viewer,
                     const glm::vec<3, Real>& to_light, Real exponent) {
  constexpr Real half_pi = std::numbers::pi_v<Real> / 2;
  const HighlightFrame<Real> frame = highlight_frame(axis, to_viewer, to_light);
  // The arc seen and lit, in angles from V, then from H.
  const Real d = frame.view_from_half_rad, psi = frame.view_from_light_rad;
  const Real lo = (psi > 0 ? -half_pi : -half_pi - psi) + d, hi = (psi > 0 ? half_pi - psi : half_pi) + d;
  const Real scale = std::sqrt(exponent / 2);
  const Real mass = std::max(Real(0), std::erf(hi * scale) - std::erf(lo * scale)) / 2;
  // The factor N.V where the highlight is brightest inside the arc.
  const Real brightest = std::clamp(Real(0), std::min(lo, hi), std::max(lo, hi));
  return std::pow(frame.sin_half, exponent) * std::sqrt(std::numbers::pi_v<Real> / (2 * exponent)) * mass *
         std::max(Real(0), std::cos(brightest - d));
}

// Share of a pixel's footprint that a needle wholly inside it covers ([Meyer00] Eq. 3), at most 1. Lengths in
// one unit, the footprint's area in its square.
template <class Real>
Real needle_opacity(Real length, Real radius, Real sin_view, Real footprint_area) {
  return std::min(Real(1), 2 * radius * length * sin_view / footprint_area);
}

}  // namespace sunfleck
