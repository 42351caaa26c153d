// Light sensors of a stand, with what was measured there.
//
// Columns: id_sensor | id | name, x, y (m), h_m | height_m (above the ground; default 1), and if measured
// pacl, pacl_direct, pacl_diffuse (shares of above-canopy light, 0 .. 1); nx, ny, nz for a tilted receiver.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "lighting/canopy/sensor_light.h"

namespace sunfleck {

struct SensorRow {
  LightSensor sensor;
  std::optional<double> pacl, pacl_direct, pacl_diffuse;
};

// Throw Error(kInvalidInput) at "name:line, column x": columns missing or doubled, not a number, a share
// outside [0, 1] (in percent: says so), two sensors of one name. kNotFound: no such file.
std::vector<SensorRow> read_sensors(const std::filesystem::path& path);
std::vector<SensorRow> parse_sensors(std::string_view csv, const std::string& name);

}  // namespace sunfleck
