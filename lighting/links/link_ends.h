// What a link ends at, in 32 bits: a face as numbered by trace::Receivers (or one of its two ends without
// light of their own), or the sky, with the direction it was left in, so that any sky can be looked up later.
// Directions: octahedral map (Cigolle et al. 2014, "A survey of efficient representations for independent
// unit vectors"), 15 and 16 bits, 1e-4 rad.
#pragma once

#include <cstdint>

#include "sim/base/vec.h"

namespace sunfleck::links {

inline constexpr std::uint32_t kSkyBit = 0x80000000u;

inline bool is_sky(std::uint32_t end) { return (end & kSkyBit) != 0; }
std::uint32_t sky_end(const Vec3& direction);  // unit, world
Vec3 sky_direction(std::uint32_t end);         // unit

}  // namespace sunfleck::links
