// What the slab solver and the closed forms it judges share: quadrature and the phase function.
#pragma once

#include <cstddef>
#include <vector>

namespace sunfleck {

// n points on (0, 1) and their weights, which sum to 1: exact for polynomials of degree 2 n - 1.
struct GaussRule {
  std::vector<double> points, weights;
};
GaussRule gauss_rule(int n);

// Henyey and Greenstein's function, per sr, and the share it sends on into the hemisphere that holds the
// direction `cosine` (to its pole) came along: T of [SPP] Eq. 10.
double henyey_greenstein(double asymmetry, double cosine);
double forward_share(double asymmetry, double cosine);

// P_l^m(mu) sqrt((l - m)! / (l + m)!) for l = 0 .. last (0 below m), without the sign (-1)^m.
std::vector<double> legendre_row(std::size_t m, std::size_t last, double mu);

}  // namespace sunfleck
