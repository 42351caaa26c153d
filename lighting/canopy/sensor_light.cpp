// See sensor_light.h.
#include "lighting/canopy/sensor_light.h"

#include <algorithm>
#include <cmath>

#include "lighting/trace/solids.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {

namespace {

constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;  // see drop_rays.cpp

double fraction(double x) { return x - std::floor(x); }

bool inside_wood(const Prototype& prototype, const Vec3& p) {
  return std::any_of(prototype.wood.begin(), prototype.wood.end(), [&](const WoodSegment& w) {
    const Vec3 from(w.from_m), axis = Vec3(w.to_m) - from;
    const double length2 = glm::dot(axis, axis);
    if (!(length2 > 0.0)) return false;
    const double part = glm::dot(p - from, axis) / length2;
    if (part < 0.0 || part > 1.0) return false;
    const double radius = w.radius_from_m + part * (w.radius_to_m - w.radius_from_m);
    const Vec3 off = p - from - part * axis;
    return glm::dot(off, off) < radius * radius;
  });
}

// The tree whose wood holds the point, in any copy next to the period; -1: none.
std::int64_t tree_around(const Forest& forest, const std::vector<double>& reach_m, const Vec3& point_m) {
  const int copies = forest.period ? 1 : 0;
  const Vec2 size = forest.period ? forest.period->size_m : Vec2(0.0);
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& tree = forest.instances[i];
    for (int x = -copies; x <= copies; ++x)
      for (int y = -copies; y <= copies; ++y) {
        Vec3 p = point_m + Vec3(x * size.x, y * size.y, 0.0);
        p.z += forest.terrain.height_at(p.x, p.y) - forest.terrain.height_at(point_m.x, point_m.y);
        const Vec2 off = Vec2(p) - Vec2(tree.position_m);
        const double reach = tree.scale * reach_m[tree.prototype.value];
        if (glm::dot(off, off) > reach * reach) continue;
        if (inside_wood(forest.prototypes[tree.prototype.value], tree_from_world(tree, p)))
          return static_cast<std::int64_t>(i);
      }
  }
  return -1;
}

void check_place(const LightSensor& s, const StandScene& scene, const std::string& where) {
  if (!std::isfinite(s.position_m.x) || !std::isfinite(s.position_m.y) || !std::isfinite(s.height_m))
    throw_invalid(where, "has a position that is no number", "finite metres");
  if (!(s.height_m > 0.0))
    throw_invalid(where, "is not above the ground (height " + std::to_string(s.height_m) + " m)",
                  "a height above the ground, more than 0");
  if (!scene.ground().contains(s.position_m.x, s.position_m.y)) {
    const Vec2 lo = scene.ground().lo_m, hi = lo + scene.ground().size_m();
    throw_invalid(where,
                  "lies outside the map at x " + std::to_string(s.position_m.x) + ", y " +
                      std::to_string(s.position_m.y),
                  "x " + std::to_string(lo.x) + " to " + std::to_string(hi.x) + ", y " +
                      std::to_string(lo.y) + " to " + std::to_string(hi.y) + " (m), or a wider map");
  }
}

}  // namespace

Vec3 sensor_point_m(const LightSensor& sensor, const StandScene& scene) {
  const Vec2 p = sensor.position_m;
  return {p, scene.forest().terrain.height_at(p.x, p.y) + sensor.height_m};
}

std::vector<LightSensor> checked(std::vector<LightSensor> sensors, const StandScene& scene) {
  const Forest& forest = scene.forest();
  std::vector<double> reach_m;
  for (const Prototype& p : forest.prototypes) reach_m.push_back(prototype_reach_m(p));
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    LightSensor& s = sensors[i];
    std::string where = "sensors[" + std::to_string(i) + "]";
    if (!s.name.empty()) where += " (" + s.name + ")";
    check_place(s, scene, where);
    const double length = glm::length(s.normal);
    if (!(length > 0.0) || !std::isfinite(length))
      throw_invalid(where + ".normal", "is no direction", "a vector of length above 0; (0, 0, 1) is level");
    s.normal /= length;
    const std::int64_t tree = tree_around(forest, reach_m, sensor_point_m(s, scene));
    if (tree >= 0)
      throw_invalid(where,
                    "stands inside the stem or a branch of tree " +
                        std::to_string(forest.instances[static_cast<std::size_t>(tree)].tree.value),
                    "a position beside it");
  }
  return sensors;
}

ResponseTable sensor_response(const StandScene& scene, const std::vector<LightSensor>& sensors,
                              const LightSource& source, int rays, std::uint64_t seed,
                              const RunControl& control) {
  ResponseTable table(ResponseTable::Kind::kShare, source.size(), sensors.size());
  const std::vector<double> strength = total_strength(source);
  for_each_chunk(source.size(), 1, control, "sensors", [&](std::size_t d, std::size_t) {
    const Vec3 axis = source.to_source[d];
    if (!(strength[d] > 0.0 && axis.z > 0.0)) return;
    const Basis around = basis_around(axis);
    const double cos_edge = std::cos(source.half_angle(d));
    const int count = cos_edge < 1.0 ? rays : 1;
    table.quantum[d] = 1.0 / count;
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      control.check();
      const Vec3 point = sensor_point_m(sensors[s], scene);
      RandomStream random(mix_seed(seed, d), s, RandomPurpose::kSensorRays);
      const double first_x = random.uniform(), first_y = random.uniform();
      int seen = 0;
      for (int k = 0; k < count; ++k) {
        const double z = 1.0 - (1.0 - cos_edge) * fraction(first_x + k * kStepX);
        const double turn = 2.0 * kPi * fraction(first_y + k * kStepY), r = std::sqrt(1.0 - z * z);
        Vec3 to = z * axis + r * (std::cos(turn) * around.tangent + std::sin(turn) * around.bitangent);
        if (!(to.z > 0.0)) to.z = -to.z;  // no light through the horizon: mirrored
        seen += scene.rays().occluded(point, to) ? 0 : 1;
      }
      table.row(d)[s] = static_cast<float>(static_cast<double>(seen) / count);
    }
  });
  return table;
}

}  // namespace sunfleck
