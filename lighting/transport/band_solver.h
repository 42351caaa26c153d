// All bounces of one band: order by order, each a sweep of what leaves, wood and ground gave back before,
// until the orders shrink by a steady factor; the rest of the series then has the shape of the last order.
// A last sweep carries all orders together.
#pragma once

#include "lighting/transport/direct_sun.h"
#include "lighting/transport/leaf_scattering.h"
#include "lighting/transport/transport_scene.h"

namespace sunfleck::transport {

struct BandProblem {
  double beam_w_m2 = 0, diffuse_w_m2 = 0, soil_albedo = 0;
  const SkySectors* sectors = nullptr;
  const std::vector<float>* sky = nullptr;  // sky_radiance(); empty: no sky
  const DirectSun* sun = nullptr;           // null: no direct light
  // What leaves scatter from. The mean closes the budget of every cell. The value in the middle makes sunlit
  // clumps give back 1 to 3 % too much, about what a marched sun loses in them.
  CellValue scattered_from = CellValue::kMean;
};

struct Convergence {
  double relative = 2e-3;
  int max_iterations = 60;
};

struct BandSolution {
  std::vector<float> scattered;          // radiance, [direction][cell]
  std::vector<float> ground_irradiance;  // of all light, per ground cell
  std::vector<FacePair> part_radiosity;  // of all light, per part
  std::vector<float> wood_radiance;      // mean incident radiance of all light, per WoodCell
  int iterations = 0;
  bool converged = true;
};

BandSolution solve_band(const TransportScene& scene, const LeafScattering& leaves, const BandProblem& problem,
                        const Convergence& convergence, const RunControl& control);

}  // namespace sunfleck::transport
