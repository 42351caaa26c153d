// Azimuths round a needle's axis of viewer, light and the half-way vector, for its highlight.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace sunfleck {

template <class Real>
struct HighlightFrame {
  Real sin_half = 0;             // s_h, of the angle between axis and H
  Real view_from_half_rad = 0;   // phi_V - phi_H in [-pi, pi]
  Real view_from_light_rad = 0;  // phi_V - phi_L in [-pi, pi]
};

// Angle from `b` to `a` round `axis`, of their parts across it; 0 where one of them has none.
template <class Real>
Real signed_azimuth(const glm::vec<3, Real>& axis, const glm::vec<3, Real>& a, const glm::vec<3, Real>& b) {
  const Real along_a = glm::dot(axis, a), along_b = glm::dot(axis, b);
  return std::atan2(glm::dot(axis, glm::cross(b, a)), glm::dot(a, b) - along_a * along_b);
}

template <class Real>
HighlightFrame<Real> highlight_frame(const glm::vec<3, Real>& axis, const glm::vec<3, Real>& to_viewer,
                                     const glm::vec<3, Real>& to_light) {
  const glm::vec<3, Real> sum = to_viewer + to_light;
  const Real length = glm::length(sum);
  if (!(length > 0)) return {};  // light from straight behind: no half-way vector, nothing seen
  const glm::vec<3, Real> half = sum / length;
  const Real along = glm::dot(axis, half);
  return {std::sqrt(std::max(Real(0), 1 - along * along)), signed_azimuth(axis, to_viewer, half),
          signed_azimuth(axis, to_viewer, to_light)};
}

}  // namespace sunfleck
