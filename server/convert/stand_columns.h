// Names and members that both directions of stand_answer.h share. For server/convert only.
#pragma once

#include <array>

#include "lighting/canopy/sensor_canopy.h"

namespace sunfleck {

inline constexpr const char* kErrorSuffix = "_standard_error";
inline constexpr double kUnixOf2000_s = 946'684'800;  // 2000-01-01T00:00 UTC

inline constexpr std::array<double SensorCanopy::*, 9> kCanopyNumbers = {&SensorCanopy::openness,
                                                                         &SensorCanopy::openness_error,
                                                                         &SensorCanopy::sky_view_factor,
                                                                         &SensorCanopy::sky_view_factor_error,
                                                                         &SensorCanopy::effective_lai_lai2000,
                                                                         &SensorCanopy::effective_lai_10_deg,
                                                                         &SensorCanopy::effective_lai_error,
                                                                         &SensorCanopy::clumped_lai,
                                                                         &SensorCanopy::clumping};
inline constexpr std::array<const char*, 9> kCanopyColumns = {"openness",
                                                              "openness_standard_error",
                                                              "sky_view_factor",
                                                              "sky_view_factor_standard_error",
                                                              "effective_lai_lai2000",
                                                              "effective_lai_10_deg",
                                                              "effective_lai_standard_error",
                                                              "clumped_lai",
                                                              "clumping"};
inline constexpr std::array<double GapRing::*, 5> kRingNumbers = {
    &GapRing::from_deg, &GapRing::to_deg, &GapRing::gap_fraction, &GapRing::standard_error,
    &GapRing::log_mean_gap};
inline constexpr std::array<const char*, 5> kRingColumns = {"from_deg", "to_deg", "gap_fraction",
                                                            "gap_fraction_standard_error", "log_mean_gap"};

}  // namespace sunfleck
