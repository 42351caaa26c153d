// Virtual hemispherical photographs at the sensors of a study.
#pragma once

#include <filesystem>
#include <vector>

#include "lighting/canopy/sensor_canopy.h"
#include "lighting/study/stand_study.h"

namespace sunfleck {

// One per sensor, the first `most` of them. Errors as hemispherical_photograph().
std::vector<HemisphericalPhotograph> photographs(const Forest& forest, const StandStudySpec& spec, int pixels,
                                                 std::size_t most, const RunControl& control);

// sensor_<name>.png for all, as they are for programs that read such photographs, and
// sensor_<name>_sun_paths.png with the ways of the sun over them (number where a sensor has no name; letters,
// digits, - and _ of it are kept) in a folder that is made where missing. Returns what was written. Throws
// Error(kInvalidInput) without sensors.
std::vector<std::filesystem::path> save_photographs(const Forest& forest, const StandStudySpec& spec,
                                                    int pixels, const std::filesystem::path& folder,
                                                    const RunControl& control);

}  // namespace sunfleck
