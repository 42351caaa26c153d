// See stability.h.
#include "lighting/bench/stability.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace {

LightRequest request_of(const LitForest& lit, const std::string& method) {
  LightRequest request;
  request.method = method_from_string(method, "stability");
  request.optics = lit.optics;
  request.light = lit.light;
  request.reference.rays_per_face = request.reference.sun_rays_per_element = 16;
  return request;
}

LightMap answer(const LitForest& lit, const std::string& method, const RunControl& control) {
  return compute_light_map(lit.forest, request_of(lit, method), {.threads = 0}, control);
}

void count_bad_numbers(const LightMap& map, SceneStability& row) {
  for (const BandLightMap& band : map.bands)
    for (const ElementLight& e : band.elements)
      for (const FaceLight& f : {e.front, e.back})
        for (const float part : {f.direct_w_m2, f.sky_w_m2, f.scattered_w_m2}) {
          row.not_finite += !std::isfinite(part);
          row.negative += part < 0.0f;
        }
}

void compare(const StabilityScene& scene, const LightMap& map, const std::string& method,
             const RunControl& control, SceneStability& row) {
  if (!scene.value) return;
  row.has_expectation = true;
  row.figure = scene.figure;
  row.found = scene.value(map);
  double noise = map.bands[0].mean_irradiance_standard_error_w_m2;
  if (scene.twin) {
    const LightMap twin = answer(*scene.twin, method, control);
    row.expected = scene.value(twin);
    noise = std::hypot(noise, twin.bands[0].mean_irradiance_standard_error_w_m2);
  } else {
    row.expected = *scene.known;
  }
  const double scale = row.expected != 0.0 ? std::abs(row.expected) : scene.light_there_is;
  row.difference = std::abs(row.found - row.expected) / scale;
  row.allowed = scene.allowed + 4.0 * noise / scale;
}

// One line: what an exception says about where and what.
std::string said_by(const Error& error) { return error.where() + ": " + error.problem(); }

SceneStability run_one(const StabilityScene& scene, const std::string& method, const RunControl& control) {
  SceneStability row;
  row.scene = scene.name;
  row.method = method;
  row.should_be_refused = scene.refuse;
  try {
    const LightMap map = answer(scene.lit, method, control);
    row.elements = map.bands[0].elements.size();
    count_bad_numbers(map, row);
    compare(scene, map, method, control, row);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    row.refused = said_by(error);
  } catch (const ContractViolation& broken) {
    row.violation = broken.what();
  }
  return row;
}

}  // namespace

bool SceneStability::safe() const {
  return not_finite == 0 && negative == 0 && violation.empty() && refused.empty() != should_be_refused;
}

bool SceneStability::as_expected() const { return safe() && (!has_expectation || difference <= allowed); }

std::vector<SceneStability> run_stability(const std::vector<StabilityScene>& scenes,
                                          const std::vector<std::string>& methods,
                                          const RunControl& control) {
  std::vector<SceneStability> rows;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    for (const std::string& method : methods) {
      control.check();
      rows.push_back(run_one(scenes[s], method, {.stop = control.stop, .progress = {}}));
    }
    control.report("stress scenes", static_cast<double>(s + 1) / static_cast<double>(scenes.size()));
  }
  return rows;
}

std::vector<SceneStability> run_stability(const RunControl& control) {
  return run_stability(stability_scenes(), method_names(), control);
}

}  // namespace sunfleck
