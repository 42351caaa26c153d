// Light at points: which share of every direction's light a sensor sees, by rays from the sensor.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lighting/canopy/light_weights.h"
#include "lighting/canopy/response_table.h"
#include "lighting/canopy/stand_scene.h"

namespace sunfleck {

// A point with a flat receiver, horizontal and facing up by default.
struct LightSensor {
  std::string name;      // as the user calls it; may be empty
  Vec2 position_m{0};    // world x (east), y (north)
  double height_m = 1;   // above the ground plane there, > 0
  Vec3 normal{0, 0, 1};  // unit after checked()
};

// Throws Error(kInvalidInput) at "sensors[i]" (with its name): position not finite, not above the ground,
// beyond the map (of a periodic forest: beyond the period), normal without length, inside a stem or branch.
std::vector<LightSensor> checked(std::vector<LightSensor> sensors, const StandScene& scene);

Vec3 sensor_point_m(const LightSensor& sensor, const StandScene& scene);

// Share of each direction's light that arrives, [direction][sensor], whatever the sensor's normal. `rays` per
// sensor and direction, spread evenly over the direction's cone; directions of no strength are skipped.
ResponseTable sensor_response(const StandScene& scene, const std::vector<LightSensor>& sensors,
                              const LightSource& source, int rays, std::uint64_t seed,
                              const RunControl& control);

}  // namespace sunfleck
