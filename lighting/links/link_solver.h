// All bounces of one band on the links: radiosity of every face,
//
//   B_front = r_f E_f + t_b E_b,  B_back = r_b E_b + t_f E_f,  E = first light + mean over links of B(met),
//
// by the iteration of trace/radiosity.h, sped up: every step the field is scaled so that the light given back
// and received balance over the scene (its mean is right at once), and the next field is the mix of the last
// two steps with the least change left (Walker and Ni 2011, "Anderson acceleration for fixed-point
// iterations", depth 1). The mix is bounded and no face falls below what first light alone gives it, so that
// a bad guess costs a few steps and nothing grows.
#pragma once

#include <span>
#include <vector>

#include "lighting/links/link_table.h"
#include "lighting/trace/radiosity.h"

namespace sunfleck::links {

// Surfaces that one task works through.
struct SurfaceRange {
  static constexpr std::uint32_t kGround = 0xFFFFFFFFu;
  std::uint32_t instance = kGround;
  std::size_t begin = 0, end = 0;  // of the tree's surfaces, or ground cells
};
// About equal work, in the order of the surfaces of each instance, the ground last.
std::vector<SurfaceRange> surface_ranges(const LinkTable& table, std::size_t ground_cells);

struct LinkProblem {
  const LinkTable& table;
  const trace::Receivers& receivers;
  std::span<const SurfaceRange> ranges;
  std::span<const trace::SurfaceOptics> optics;  // per surface
  std::span<const float> first_light_w_m2;       // per face
};

struct LinkSolution {
  std::vector<float> radiosity_w_m2;  // per face
  int iterations = 0;
  bool converged = true;
};

// A surface, its first face, and what falls on its faces by the light of a field of radiosities.
struct LitSurface {
  std::size_t surface = 0, face = 0;
  bool has_back = true, is_shoot = false;  // a shoot's faces are needles turned any way: both are lit alike
  double front_w_m2 = 0, back_w_m2 = 0;
};
LitSurface dark_surface(const LinkTable& table, const trace::Receivers& receivers, const SurfaceRange& range,
                        std::size_t local);
LitSurface scattered_light(const LinkProblem& problem, const SurfaceRange& range, std::size_t local,
                           const std::vector<float>& radiosity_w_m2);

LinkSolution solve(const LinkProblem& problem, const trace::Convergence& convergence,
                   const RunControl& control);

}  // namespace sunfleck::links
