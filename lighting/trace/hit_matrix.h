// The hit matrix: what every ray that leaves a face meets, and the sky it sees where it meets nothing.
// Independent of sun, bands and optics. Rays start evenly over the face, cosine-distributed, spread by
// low-discrepancy points in directions first, and are counted by groups, for the standard errors
// (jackknife.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lighting/sky/illumination.h"
#include "lighting/trace/jackknife.h"
#include "lighting/trace/receivers.h"
#include "sim/base/run_control.h"

namespace sunfleck::trace {

struct HitMatrix {
  int rays = 0;                     // per face
  std::vector<std::uint32_t> hits;  // [face][ray]: what it met, as numbered by Receivers
  // Per face and group: sum over rays to the sky of pi * radiance (for a diffuse irradiance of 1), and the
  // number of rays that met nothing which gives light back.
  std::vector<std::array<float, kGroups>> sky;
  std::vector<std::array<std::uint16_t, kGroups>> lost;
  std::vector<float> sky_squares;  // per face: sum of squares of the sky terms

  const std::uint32_t* row(std::size_t face) const {
    return hits.data() + face * static_cast<std::size_t>(rays);
  }
};

// Bytes of a matrix and of what is solved on it.
std::uint64_t hit_matrix_bytes(std::size_t faces, int rays);

// Traces rays number matrix.rays .. rays - 1 of every face, surface by surface in the given order.
void extend(HitMatrix& matrix, int rays, const RayScene& scene, const Receivers& receivers,
            std::span<const std::uint32_t> order, const SkyRadiance& sky, std::uint64_t seed,
            const RunControl& control);

}  // namespace sunfleck::trace
