// Compares a drawing with the geometry block of a golden case.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/lsystem/lsystem.h"

namespace sunfleck::lsystem {

// To 1e-6 relative to the size of the drawing (the numbers are rounded to 1e-9).
void expect_geometry(const Drawing& drawing, const nlohmann::json& expected);

}  // namespace sunfleck::lsystem
