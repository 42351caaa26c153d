// Direct sun on every face by shadow rays from random points. The sun is a disc of even radiance (or a
// point); a beam of 1 puts 1 on a plane that faces it.
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

struct SunLight {
  int rays = 0;                                      // per surface; 0: no sun
  std::vector<std::array<float, kGroups>> received;  // per face and group: sum over rays of visible * cosine
  std::vector<std::uint32_t> visible;                // per surface: rays that reach the sun
};

// Casts rays number sun.rays .. rays - 1 of every surface, in the given order.
void extend(SunLight& sun, int rays, const RayScene& scene, const Receivers& receivers,
            std::span<const std::uint32_t> order, const Illumination& light, std::uint64_t seed,
            const RunControl& control);

}  // namespace sunfleck::trace
