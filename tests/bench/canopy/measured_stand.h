// The measured stands in ../shared/data/stands as forests with homogeneous crowns, and their sensors.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lighting/canopy/sensor_light.h"
#include "sim/forest/forest.h"

namespace sunfleck::bench {

struct MeasuredStand {
  Forest forest;
  Vec2 map_lo_m{0}, map_hi_m{0};  // rectangle round the plot polygon, without its trees' overhang
  std::vector<LightSensor> sensors;
  std::vector<double> pacl, pacl_direct, pacl_diffuse;  // measured, per sensor
};
// `folder` of the stand; every measured crown evenly filled with `leaves` leaves. `periodic`: the rectangle
// repeats.
MeasuredStand measured_stand(const std::filesystem::path& folder, int leaves, bool periodic);

// Of `ours` against `measured`.
struct Agreement {
  double rmse = 0, bias = 0, correlation = 0, spread = 0;  // spread: standard deviation of ours
};
Agreement agreement(const std::vector<double>& ours, const std::vector<double>& measured);

}  // namespace sunfleck::bench
