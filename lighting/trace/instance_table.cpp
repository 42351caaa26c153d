#include <embree3/rtcore.h>

#include "lighting/trace/instance_table.h"

#include <cmath>
#include <limits>

#include "sim/base/error.h"

namespace sunfleck::trace {
namespace {

TreeRow row_of(const Instance& instance, const Vec3& centre_m) {
  const double scale = instance.scale, yaw = instance.yaw_rad;
  return {Vec3f(instance.position_m - centre_m), static_cast<float>(std::cos(yaw) / scale),
          static_cast<float>(std::sin(yaw) / scale), static_cast<float>(1.0 / scale)};
}

Vec3f into_tree(const TreeRow& row, const Vec3f& v) {
  return {row.cos_by_scale * v.x + row.sin_by_scale * v.y, row.cos_by_scale * v.y - row.sin_by_scale * v.x,
          row.one_by_scale * v.z};
}

// Ways of a ray in and out of the tree's coordinates; distances along it stay what they are.
struct SavedRay {
  Vec3f origin, direction;
};

SavedRay take_into_tree(const TreeRow& row, RTCRay& ray) {
  const SavedRay saved{{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}};
  const Vec3f origin = into_tree(row, saved.origin - row.place_m),
              direction = into_tree(row, saved.direction);
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  return saved;
}

void take_back(const SavedRay& saved, RTCRay& ray) {
  ray.org_x = saved.origin.x, ray.org_y = saved.origin.y, ray.org_z = saved.origin.z;
  ray.dir_x = saved.direction.x, ray.dir_y = saved.direction.y, ray.dir_z = saved.direction.z;
}

const InstanceTable& table_of(void* pointer) { return *static_cast<const InstanceTable*>(pointer); }

RTCScene scene_of(const InstanceTable& table, unsigned tree) {
  return (*table.figures)[table.prototype_of(tree).value].scene.get();
}

// The box of the prototype turned about the stem, cut by the circle that holds the tree; a millionth wider
// for the rounding of the row.
void tree_bounds(const RTCBoundsFunctionArguments* args) {
  const InstanceTable& table = table_of(args->geometryUserPtr);
  const Instance& instance = table.forest->instances[args->primID];
  const PrototypeId prototype = table.prototype_of(args->primID);
  const Box& box = table.boxes[prototype.value];
  RTCBounds& to = *args->bounds_o;
  if (box.empty()) {
    to.lower_x = to.lower_y = to.lower_z = std::numeric_limits<float>::infinity();
    to.upper_x = to.upper_y = to.upper_z = -std::numeric_limits<float>::infinity();
    return;
  }
  const double scale = instance.scale, c = std::cos(static_cast<double>(instance.yaw_rad)),
               s = std::sin(static_cast<double>(instance.yaw_rad));
  const Vec3 middle = box.centre(), half = 0.5 * (box.hi - box.lo);
  const Vec3 place(table.rows[args->primID].place_m);
  const double reach = table.reaches_m[prototype.value];
  const Vec2 turned(c * middle.x - s * middle.y, s * middle.x + c * middle.y);
  const Vec2 wide(std::abs(c) * half.x + std::abs(s) * half.y, std::abs(s) * half.x + std::abs(c) * half.y);
  const Vec3 lo(std::max(turned.x - wide.x, -reach), std::max(turned.y - wide.y, -reach), box.lo.z);
  const Vec3 hi(std::min(turned.x + wide.x, reach), std::min(turned.y + wide.y, reach), box.hi.z);
  const Vec3 a = place + scale * lo, b = place + scale * hi;
  const double margin = 1e-6 * (glm::length(a) + glm::length(b));
  to.lower_x = static_cast<float>(a.x - margin), to.lower_y = static_cast<float>(a.y - margin);
  to.lower_z = static_cast<float>(a.z - margin), to.upper_x = static_cast<float>(b.x + margin);
  to.upper_y = static_cast<float>(b.y + margin), to.upper_z = static_cast<float>(b.z + margin);
}

void tree_intersect(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  const InstanceTable& table = table_of(args->geometryUserPtr);
  auto& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const SavedRay saved = take_into_tree(table.rows[args->primID], rayhit.ray);
  args->context->instID[0] = args->primID;
  rtcIntersect1(scene_of(table, args->primID), args->context, &rayhit);
  args->context->instID[0] = RTC_INVALID_GEOMETRY_ID;
  take_back(saved, rayhit.ray);
}

void tree_occluded(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  const InstanceTable& table = table_of(args->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  const SavedRay saved = take_into_tree(table.rows[args->primID], ray);
  args->context->instID[0] = args->primID;
  rtcOccluded1(scene_of(table, args->primID), args->context, &ray);
  args->context->instID[0] = RTC_INVALID_GEOMETRY_ID;
  take_back(saved, ray);
}

}  // namespace

InstanceTable make_instance_table(const Forest& forest, const std::vector<PrototypeScene>& figures,
                                  const std::vector<PrototypeId>& prototypes, const Vec3& centre_m) {
  if (forest.instances.size() >= std::numeric_limits<unsigned>::max())
    throw Error(ErrorKind::kLimitExceeded, "forest", "has more trees than can be numbered",
                "at most 4294967294");
  InstanceTable table;
  table.forest = &forest;
  table.figures = &figures;
  table.prototypes = prototypes;
  for (const Prototype& p : forest.prototypes) {
    table.boxes.push_back(prototype_bounds(p));
    table.reaches_m.push_back(prototype_reach_m(p));
  }
  table.rows.reserve(forest.instances.size());
  for (const Instance& instance : forest.instances) table.rows.push_back(row_of(instance, centre_m));
  return table;
}

SceneCopy copy_in_table(const InstanceTable& table, unsigned tree) {
  const Instance& instance = table.forest->instances[tree];
  const PrototypeId prototype = table.prototype_of(tree);
  return {tree,
          {},
          prototype,
          &(*table.figures)[prototype.value],
          std::cos(static_cast<double>(instance.yaw_rad)),
          std::sin(static_cast<double>(instance.yaw_rad))};
}

SceneHandle build_table_scene(const Device& device, InstanceTable& table, const RunControl& control) {
  SceneHandle scene(rtcNewScene(device.get()));
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(table.rows.size()));
  rtcSetGeometryUserData(geometry, &table);
  rtcSetGeometryBoundsFunction(geometry, tree_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, tree_intersect);
  rtcSetGeometryOccludedFunction(geometry, tree_occluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
  commit(device, scene.get(), control);
  return scene;
}

}  // namespace sunfleck::trace
