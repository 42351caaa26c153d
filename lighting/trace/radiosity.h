// Iterates the light that surfaces pass between each other on the hit matrix: radiosity of every face for
// one band. Solved once with all rays, then once without each group of rays (jackknife.h), starting from the
// full solution.
//
//   B_front = r_f E_f + t_b E_b,  B_back = r_b E_b + t_f E_f,  E = first light + mean over rays of B(met)
//
// Between two steps the field is scaled so that the light scattered and received balance over the scene
// (the mean is then right at once and only its distribution has to settle).
#pragma once

#include <array>
#include <vector>

#include "lighting/trace/hit_matrix.h"
#include "lighting/trace/sun_light.h"

namespace sunfleck::trace {

// What one band puts on the faces before any scattering.
struct BandSources {
  double beam_w_m2 = 0, diffuse_w_m2 = 0;
  double ground_beyond_w_m2 = 0;  // radiosity of the ground beyond the cells
};

// Everything the solution of a band is made from.
struct BandProblem {
  const Receivers& receivers;
  const HitMatrix& matrix;
  const SunLight& sun;
  std::vector<SurfaceOptics> optics;
  BandSources sources;
  int fewest_rays = 0;  // that anything rests on: per face, or towards the sun per surface
};

struct Convergence {
  double relative = 1e-4;  // of scattered power
  int max_iterations = 200;
};

template <std::size_t lanes>
struct Radiosity {
  std::vector<std::array<float, lanes>> of_face;  // W m-2; the three ends of Receivers follow the faces
  int iterations = 0;
  bool converged = true;
};

// Light on a face from sun, sky and the ground beyond, before any scattering.
struct FirstLight {
  double direct_w_m2 = 0, sky_w_m2 = 0, beyond_w_m2 = 0;
  GroupValues without_group{};  // their sum, without each group of rays
  double total() const { return direct_w_m2 + sky_w_m2 + beyond_w_m2; }
};
FirstLight first_light(const BandProblem& problem, std::size_t face);

// Radiosities of a surface's two faces from their irradiances; a ground cell has no second face.
template <std::size_t lanes>
struct FacePair {
  std::array<double, lanes> front{}, back{};
};
template <std::size_t lanes>
FacePair<lanes> given_back(const SurfaceOptics& o, const FacePair<lanes>& e) {
  FacePair<lanes> b;
  for (std::size_t l = 0; l < lanes; ++l) {
    b.front[l] = o.reflect_front * e.front[l] + o.pass_back * e.back[l];
    b.back[l] = o.reflect_back * e.back[l] + o.pass_front * e.front[l];
  }
  return b;
}

Radiosity<1> solve(const BandProblem& problem, const Convergence& convergence, const RunControl& control);
Radiosity<kGroups> solve_without_groups(const BandProblem& problem, const Radiosity<1>& full,
                                        const Convergence& convergence, const RunControl& control);

// Mean radiosity met by all rays of a face.
double mean_met(const BandProblem& problem, const Radiosity<1>& radiosity, std::size_t face);
// For each group: mean of its radiosities met by all rays, and by all rays but its own.
struct GroupMeans {
  GroupValues by_all_rays, without_own_rays;
};
GroupMeans mean_met(const BandProblem& problem, const Radiosity<kGroups>& radiosity, std::size_t face);

}  // namespace sunfleck::trace
