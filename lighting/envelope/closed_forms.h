// The closed forms of envelope lighting [Boulanger08]: leaf averages over uniformly distributed normals and
// the light that one bounce of parallel light brings along a direction.
//
// What enters: angles between directions, optical depths, leaf reflectance and transmittance. What comes out:
// irradiance or sector-integrated radiance in the unit of the light's own irradiance. Assumes bi-Lambertian
// leaves with uniformly distributed normals (leaf projection 1/2); it stops being true for leaves that mostly
// lie flat or stand upright. Every form here is the printed one rearranged so that nothing cancels, divides
// by zero or overflows; the printed forms stay in the tests as the thing to be better than.
//
// All templates are instantiated for double and float.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>

namespace sunfleck::envelope {

template <class Real>
using Direction = glm::vec<3, Real>;

// h(x) = sin x - x cos x on [0, pi]: the only special function the model needs; never negative.
template <class Real>
Real lobe_function(Real x);

// phi(x) = (1 - exp(-x)) / x, 1 at x = 0; any finite x (a negative one may overflow to infinity below -700).
template <class Real>
Real mean_decay(Real x);

// The angle between two directions in [0, pi], and what is missing to pi, both to full relative precision.
template <class Real>
struct AnglePair {
  Real angle_rad = 0, supplement_rad = 0;
};
template <class Real>
AnglePair<Real> angle_between(const Direction<Real>& a, const Direction<Real>& b);
// The same from an angle; the supplement is as good as `angle_rad` allows.
AnglePair<double> angle_pair(double angle_rad);

// Means over all leaf normals N of M(N.l) M(N.w) (light passes through the leaf, Avt, Eq. 31) and
// M(N.l) M(-N.w) (light is thrown back, Avr, Eq. 32) for light l and view -w at an angle between l and w.
template <class Real>
Real mean_transmitting_cosines(const AnglePair<Real>& angles);
template <class Real>
Real mean_reflecting_cosines(const AnglePair<Real>& angles);

// Sums over both faces: r_f + r_b and t_f + t_b.
template <class Real>
struct LeafSums {
  Real reflectance = 0, transmittance = 0;
};

// B = Rs h(alpha) + Ts h(pi - alpha): how strongly leaves turn light by alpha. Its mean over the sphere times
// 4 pi / (3 pi^2) is the leaf albedo r + t.
template <class Real>
Real scattering_lobe(const LeafSums<Real>& leaf, const AnglePair<Real>& angles);

// G1 of Eq. 18 in 1/m^3: leaf number density in 1/m^3, number of sample directions.
template <class Real>
Real scattering_density(Real leaves_per_m3, int directions, const LeafSums<Real>& leaf,
                        const AnglePair<Real>& angles);

// Weights M(l.w_j) / sum M of Eq. 7 into `weights`; returns sum M. Where that sum is below 1e-6 (a one-sided
// or custom set of directions) the direction closest to the light gets all the weight. `to_light` is unit.
template <class Real>
Real interpolation_weights(std::span<const Direction<Real>> directions, const Direction<Real>& to_light,
                           std::span<Real> weights);

// sum_k weight_k value_k, S0 of a sample (added in double, as exp(-tau S0) multiplies its error by tau S0).
template <class Real>
Real interpolated(std::span<const Real> weights, std::span<const Real> values);

// c_j = sum_k weight_k (w_j.w_k): by how much the interpolated distance to the envelope shrinks per metre
// towards w_j; G3 = tau (1 - c_j), Eq. 25.
template <class Real>
Real approach_towards(std::span<const Direction<Real>> directions, std::span<const Real> weights,
                      std::size_t j);

// Eq. 23 as printed but for the division: G1 E exp(-tau S0) s phi(G3 s), W/m^4. Its depth towards the light
// may become negative at the far end of s, then it promises more light than there is.
template <class Real>
struct PublishedSector {
  Real scattering_per_m3 = 0;  // G1
  Real extinction_per_m = 0;   // tau
  Real light_distance_m = 0;   // S0
  Real approach = 0;           // c_j
  Real sector_distance_m = 0;  // s_j
  Real irradiance_w_m2 = 0;    // E of the light
};
template <class Real>
Real published_sector_sample(const PublishedSector<Real>& sector);

// Integral over x from 0 to D of exp(-max(0, D0 - c x)) exp(-x): light reaching the leaves along a sector of
// depth D and coming back, with depth D0 to the light at the start that shrinks by c per unit. Exact, never
// a negative depth; 0 <= J <= 1. D0, D >= 0, any c.
template <class Real>
Real one_bounce_integral(Real depth_to_light, Real approach, Real sector_depth);

// Sector-integrated radiance (W/m^2) of one bounce towards the leaf: Om / (3 pi^2) B E J; the dimensionless
// twin of A times Eq. 23, free of density, leaf area and distance.
template <class Real>
Real one_bounce_sector(Real solid_angle_sr, Real lobe, Real irradiance_w_m2, Real integral);

// The eight cube corners of Eq. 26, in its order: opposite directions are j and 7 - j; bit 0 of j is set
// where x > 0, bit 1 where z > 0, bit 2 where y > 0.
template <class Real>
const std::array<Direction<Real>, 8>& cube_directions();

}  // namespace sunfleck::envelope
