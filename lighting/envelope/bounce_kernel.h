// One bounce along all sectors of one leaf at once: J of closed_forms.h in floats, eight lanes at a
// time. The plain twin calls the closed form in double; both agree to 4e-6 of the largest possible value, 1.
//
// Rows are padded with zeros to kLaneCount: a sector set of n directions takes padded(n) floats.
#pragma once

#include <cstddef>
#include <span>

namespace sunfleck::envelope {

inline constexpr std::size_t kLaneCount = 8;
constexpr std::size_t padded(std::size_t count) { return (count + kLaneCount - 1) / kLaneCount * kLaneCount; }

// integral[k] = J(depth_to_light[k], approach[k], sector_depth): light that comes along k, turned on the way
// to the leaf along one sector. All spans as long as a row; depths in [0, kLargestDepth], approach in [-1e3,
// 1e3].
void bounce_row(std::span<const float> depth_to_light, std::span<const float> approach, float sector_depth,
                std::span<float> integral);
void bounce_row_plain(std::span<const float> depth_to_light, std::span<const float> approach,
                      float sector_depth, std::span<float> integral);

// integral[j] = J(depth_to_light, approach[j], sector_depth[j]): one light seen along every sector.
void bounce_sectors(float depth_to_light, std::span<const float> approach,
                    std::span<const float> sector_depth, std::span<float> integral);
void bounce_sectors_plain(float depth_to_light, std::span<const float> approach,
                          std::span<const float> sector_depth, std::span<float> integral);

// through[k] = exp(-depth[k]), 4e-7 relative for depths up to 80.
void transmittances(std::span<const float> depth, std::span<float> through);

// sum_k a[k] b[k] c[k] of three rows.
float row_product(std::span<const float> a, std::span<const float> b, std::span<const float> c);

}  // namespace sunfleck::envelope
