// The closed forms for rows of depths at once, in vector registers: float in, float out. The same formulas as
// spp.h, spp_h.h and compensation.h, which are the plain twins; tests/lighting/slab/slab_rows_test.cpp ties
// them.
//
// AVX-512 where the machine has it, else what the build targets; both give answers within the stated errors.
// Depths above kDeepestRow count as kDeepestRow.
#pragma once

#include <span>

#include "lighting/slab/spp.h"
#include "lighting/slab/spp_h.h"

namespace sunfleck {

inline constexpr float kDeepestRow = 1e6f;

// What spp() needs of a medium, once per row.
struct SppRowMedium {
  float decay = 0;           // lambda, at least 1e-12
  float turned = 0;          // b r = a - lambda
  float forward = 0;         // omega T
  float ground = 0;          // rho
  float up_sine = 0;         // b (1 - rho r) / (2 lambda)
  float thickness_sine = 0;  // A / (2 lambda)
  float down_sine = 0;       // b (rho - r) / (2 lambda)
};
SppRowMedium row_medium(const SlabMedium<double>& medium);

// Which code runs: kPlainCode is what the build targets, for tests.
enum class RowCode { kBest, kPlainCode };

// `down` and `up` of spp() for every pair of depths; all spans of one size. Error against spp<double>() below
// 5e-5 of down + up, plus 4e-7 of min(1, before).
void spp_row(std::span<const float> before, std::span<const float> behind, const SppRowMedium& medium,
             std::span<float> down, std::span<float> up, RowCode code = RowCode::kBest);

// The same for spp_h(), computed in double. Error against spp_h() below 2e-7 of down + up (rounding to float)
// while absorption is above 1e-10.
void spp_h_row(std::span<const float> before, std::span<const float> behind, const HemisphereMedium& medium,
               std::span<float> down, std::span<float> up, RowCode code = RowCode::kBest);

// Adds compensation_shortfall() of one sample direction to `sum`. Absolute error below 5e-6.
void add_shortfall_row(std::span<const float> before, std::span<const float> behind,
                       std::span<const float> boundary_depth, double cosine, std::span<float> sum,
                       RowCode code = RowCode::kBest);

}  // namespace sunfleck
