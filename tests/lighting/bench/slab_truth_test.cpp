// The slab solver against what is known on paper: Chandrasekhar's H function, a printed value of van de
// Hulst, single scattering, conservation; and the closed forms scored with it.
#include "lighting/bench/slab_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lighting/bench/slab_errors.h"
#include "sim/base/error.h"
#include "sim/base/vec.h"

namespace sunfleck {
namespace {

TEST(GaussRule, IsExactForPolynomials) {
  for (const int n : {4, 16, 32}) {
    const GaussRule rule = gauss_rule(n);
    for (const int power : {0, 1, 2 * n - 1}) {
      double sum = 0;
      for (std::size_t i = 0; i < rule.points.size(); ++i)
        sum += rule.weights[i] * std::pow(rule.points[i], power);
      EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-14) << n << ", " << power;  // some roundings
    }
  }
}

TEST(HenyeyGreenstein, ScattersAllItScatters) {
  const GaussRule rule = gauss_rule(32);
  for (const double g : {-0.5, 0.0, 0.5, 0.7}) {
    double forward = 0, all = 0;  // beam along the pole: both halves of the sphere
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
      const double mu = rule.points[i], weight = 2 * kPi * rule.weights[i];
      forward += weight * henyey_greenstein(g, mu);
      all += weight * (henyey_greenstein(g, mu) + henyey_greenstein(g, -mu));
    }
    EXPECT_NEAR(all, 1.0, 1e-9) << g;                        // 32 points, poles of g = .7 outside [-1, 1]
    EXPECT_NEAR(forward_share(g, 1.0), forward, 1e-9) << g;  // series to .7^121
    EXPECT_NEAR(forward_share(g, 0.0), 0.5, 1e-12) << g;     // as much on either side of the border
    EXPECT_NEAR(forward_share(-g, 0.6), 1 - forward_share(g, 0.6), 1e-12) << g;
  }
}

// H(mu) of isotropic scattering by fixed-point iteration of 1/H = sqrt(1 - w) + w/2 int x H(x) / (mu + x) dx.
double h_function(double albedo, double mu0) {
  const GaussRule rule = gauss_rule(32);
  std::vector<double> h(rule.points.size(), 1.0);
  const auto at = [&](double mu) {
    double integral = 0;
    for (std::size_t i = 0; i < h.size(); ++i)
      integral += rule.weights[i] * rule.points[i] * h[i] / (mu + rule.points[i]);
    return 1.0 / (std::sqrt(1 - albedo) + 0.5 * albedo * integral);
  };
  for (int step = 0; step < 200; ++step) {
    std::vector<double> next;
    for (const double mu : rule.points) next.push_back(at(mu));
    h = next;
  }
  return at(mu0);
}

// Plane albedo of a half-space is 1 - sqrt(1 - albedo) H(mu0). Thickness 60: at albedo .9 what comes from
// deeper is below e^-60. 1e-5: layers start at 1e-7 thickness, 1e-5 of the most level direction.
TEST(SlabTruth, OfAHalfSpaceIsChandrasekhars) {
  for (const double albedo : {0.5, 0.9}) {
    const SlabField field = solve_slab(
        {.albedo = albedo, .asymmetry = 0, .thickness = 60, .layers = 4, .beam_cosines = {1.0, 0.5, 0.1}},
        {});
    const double mu[] = {1.0, 0.5, 0.1};
    for (std::size_t b = 0; b < 3; ++b) {
      const double expected = 1 - std::sqrt(1 - albedo) * h_function(albedo, mu[b]);
      EXPECT_NEAR(field.sums(b, 0).flux_up / mu[b], expected, 1e-5) << albedo << ", " << mu[b];
    }
  }
}

// van de Hulst 1980, quoted by Prahl et al. 1993, Table 1: albedo .9, g = .75, thickness 2, square beam:
// reflects .09739, passes .66096 with the beam. 1e-4: the series stops at .75^31 = 1.3e-4.
TEST(SlabTruth, OfForwardScatterersIsVanDeHulsts) {
  const SlabField field =
      solve_slab({.albedo = 0.9, .asymmetry = 0.75, .thickness = 2, .layers = 2, .beam_cosines = {1.0}}, {});
  EXPECT_NEAR(field.sums(0, 0).flux_up, 0.09739, 1e-4);
  EXPECT_NEAR(field.sums(0, 2).flux_down + std::exp(-2.0), 0.66096, 1e-4);
}

// Without absorption the net flux is the same at every depth. 1e-5 as above.
TEST(SlabTruth, LosesNothingWithoutAbsorption) {
  for (const double g : {-0.5, 0.0, 0.5}) {
    const std::vector<double> mu = {1.0, 0.3};
    const SlabField field =
        solve_slab({.albedo = 1, .asymmetry = g, .thickness = 5, .layers = 5, .beam_cosines = mu}, {});
    for (std::size_t b = 0; b < mu.size(); ++b)
      for (std::size_t k = 0; k < field.levels(); ++k) {
        const auto net = [&](std::size_t level) {
          const SlabField::Sums s = field.sums(b, level);
          return s.flux_down - s.flux_up + mu[b] * std::exp(-static_cast<double>(level) / mu[b]);
        };
        EXPECT_NEAR(net(k), net(0), 1e-5) << g << ", " << mu[b] << ", " << k;
      }
  }
}

// Leaves that scatter a trace: radiance is one integral of the phase function, known in closed form; this
// holds the Fourier modes to the azimuth of each direction.
TEST(SlabTruth, ScattersOnceWhereAlbedoIsSmall) {
  const double albedo = 1e-6, mu0 = 0.6, depth = 1.0, g = 0.5;
  const SlabField field =
      solve_slab({.albedo = albedo, .asymmetry = g, .thickness = 2, .layers = 2, .beam_cosines = {mu0}}, {});
  for (std::size_t i = 4; i < field.cosines().size(); i += 3)
    for (const double azimuth : {0.0, 1.0, kPi}) {
      const double mu = field.cosines()[i], level = std::sqrt((1 - mu * mu) * (1 - mu0 * mu0));
      const double down = albedo * henyey_greenstein(g, mu * mu0 + level * std::cos(azimuth)) * mu0 /
                          (mu0 - mu) * (std::exp(-depth / mu0) - std::exp(-depth / mu));
      const double up = albedo * henyey_greenstein(g, -mu * mu0 + level * std::cos(azimuth)) * mu0 /
                        (mu0 + mu) * std::exp(-depth / mu0) * (1 - std::exp(-depth * (1 / mu + 1 / mu0)));
      EXPECT_NEAR(field.down(0, 1, i, azimuth), down, 1e-5 * down) << mu << ", " << azimuth;
      EXPECT_NEAR(field.up(0, 1, i, azimuth), up, 1e-5 * up) << mu << ", " << azimuth;
    }
}

TEST(SlabTruth, DoesNotDependOnItsLayers) {
  const auto at = [](int layers, int directions) {
    return solve_slab({.albedo = 0.95,
                       .asymmetry = 0.5,
                       .thickness = 3,
                       .layers = layers,
                       .beam_cosines = {0.5},
                       .directions = directions},
                      {});
  };
  const auto few = at(3, 16), many = at(6, 24);
  for (std::size_t k = 0; k <= 3; ++k) {
    EXPECT_NEAR(few.sums(0, k).fluence_up, many.sums(0, 2 * k).fluence_up, 1e-5);
    EXPECT_NEAR(few.sums(0, k).fluence_down, many.sums(0, 2 * k).fluence_down, 1e-5);
  }
}

TEST(SlabTruth, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(solve_slab({.beam_cosines = {1.0}}, {.stop = source.get_token(), .progress = {}}), Error);
}

// Where light is scattered once at most, the refined form is exact and the simplified one is not.
TEST(SlabErrors, OfTheRefinedFormVanishWithTheAlbedo) {
  const SlabErrors e = slab_errors({.albedo = 1e-5, .asymmetry = 0.5, .beam_cosines = {0.8, 0.4}}, {}, {});
  EXPECT_LT(e.refined.scattered, 1e-4);  // albedo, and 1e-5 of the truth in level directions
  EXPECT_GT(e.simplified.scattered, 0.3);
  EXPECT_NEAR(e.only_beam.scattered, 1.0, 1e-12);
}

}  // namespace
}  // namespace sunfleck
