#include <embree3/rtcore.h>

#include "lighting/trace/embree_scene.h"

#include <array>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck::trace {
namespace {

struct Corner {
  float x, y, z;
};
struct Corner4 {
  float x, y, z, w;
};
Corner corner(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

bool count_memory(void* total, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::int64_t>*>(total) += bytes;
  return true;
}

// A ray does not hit the flat leaf or wood triangle it starts on, nor a tree it passes.
template <HitKind kind>
void skip_start(const RTCFilterFunctionNArguments* args) {
  const auto& context = *reinterpret_cast<const RayContext*>(args->context);
  const auto& prototype = *static_cast<const PrototypeScene*>(args->geometryUserPtr);
  const unsigned primitive = RTCHitN_primID(args->hit, args->N, 0);
  const unsigned slot = RTCHitN_geomID(args->hit, args->N, 0) % kSlots;
  const unsigned copy = copy_met(prototype, RTCHitN_instID(args->hit, args->N, 0, 0));
  const std::uint32_t local = slot == kQuads   ? prototype.quad_elements[primitive]
                              : slot == kDiscs ? prototype.disc_elements[primitive]
                                               : primitive;
  if (is_start(context, copy, kind, local) || is_passed(context, copy)) args->valid[0] = 0;
}

template <HitKind kind>
void attach(RTCGeometry geometry, Slot slot, const Target& to, PrototypeScene& out) {
  rtcSetGeometryUserData(geometry, &out);
  rtcSetGeometryIntersectFilterFunction(geometry, skip_start<kind>);
  rtcSetGeometryOccludedFilterFunction(geometry, skip_start<kind>);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to.scene, geometry, to.first_id + slot);
  rtcReleaseGeometry(geometry);
}

template <class T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  return static_cast<T*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count));
}

// Counter-clockwise seen from the front; a triangle repeats its last corner.
std::array<Vec3, 4> corners(const FoliageElement& e) {
  const Vec3 c(e.centre_m), u(e.half_u_m), v(e.half_v_m);
  if (e.shape == ElementShape::kParallelogram) return {c - u - v, c + u - v, c + u + v, c - u + v};
  const Vec3 a = c - (u + v) / 3.0;
  return {a, a + u, a + v, a + v};
}

void add_quads(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  if (out.quad_elements.empty()) return;
  const std::size_t count = out.quad_elements.size();
  const RTCGeometry geometry = rtcNewGeometry(to.device.get(), RTC_GEOMETRY_TYPE_QUAD);
  auto* points = new_buffer<Corner>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 4 * count);
  auto* indexes =
      new_buffer<std::array<unsigned, 4>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT4, count);
  to.device.check("leaf buffers");
  for (std::size_t i = 0; i < count; ++i) {
    const auto quad = corners(prototype.foliage[out.quad_elements[i]]);
    for (std::size_t k = 0; k < 4; ++k) {
      points[4 * i + k] = corner(to.placement.point(quad[k]));
      indexes[i][k] = static_cast<unsigned>(4 * i + k);
    }
  }
  attach<HitKind::kFoliage>(geometry, kQuads, to, out);
}

void add_discs(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  if (out.disc_elements.empty()) return;
  const std::size_t count = out.disc_elements.size();
  const RTCGeometry geometry = rtcNewGeometry(to.device.get(), RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  auto* points = new_buffer<Corner4>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, count);
  auto* normals = new_buffer<Corner>(geometry, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, count);
  to.device.check("leaf buffers");
  for (std::size_t i = 0; i < count; ++i) {
    const FoliageElement& e = prototype.foliage[out.disc_elements[i]];
    const double radius = to.placement.scale() * glm::length(Vec3(e.half_u_m));
    const Corner at = corner(to.placement.point(Vec3(e.centre_m)));
    points[i] = {at.x, at.y, at.z, static_cast<float>(radius)};
    normals[i] = corner(to.placement.direction(element_normal(e)));
  }
  attach<HitKind::kFoliage>(geometry, kDiscs, to, out);
}

void add_wood_triangles(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  if (prototype.wood_mesh.empty()) return;
  const std::size_t count = prototype.wood_mesh.size();
  const RTCGeometry geometry = rtcNewGeometry(to.device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = new_buffer<Corner>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * count);
  auto* indexes =
      new_buffer<std::array<unsigned, 3>>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, count);
  to.device.check("wood buffers");
  for (std::size_t i = 0; i < count; ++i) {
    const WoodTriangle& t = prototype.wood_mesh[i];
    std::size_t k = 3 * i;
    for (const Vec3f& p : {t.a_m, t.b_m, t.c_m}) points[k++] = corner(to.placement.point(Vec3(p)));
    const auto first = static_cast<unsigned>(3 * i);
    indexes[i] = {first, first + 1, first + 2};
  }
  attach<HitKind::kWoodMesh>(geometry, kWoodTriangles, to, out);
}

void sort_elements_by_shape(const Prototype& prototype, PrototypeScene& out) {
  for (std::size_t i = 0; i < prototype.foliage.size(); ++i) {
    const ElementShape shape = prototype.foliage[i].shape;
    auto& list = shape == ElementShape::kShoot  ? out.shoot_elements
                 : shape == ElementShape::kDisc ? out.disc_elements
                                                : out.quad_elements;
    list.push_back(static_cast<std::uint32_t>(i));
  }
}

}  // namespace

bool is_start(const RayContext& context, unsigned copy, HitKind kind, std::uint32_t local) {
  if (kind != context.from.kind || local != context.from.local) return false;
  const PlacedInstance c = placed_instance(context, copy);
  return c.instance == context.from.instance && c.shift.x + context.cell.x == 0 &&
         c.shift.y + context.cell.y == 0;
}

bool is_empty(const Prototype& prototype) {
  return prototype.foliage.empty() && prototype.wood.empty() && prototype.wood_mesh.empty();
}

Device::Device() : device_(rtcNewDevice(nullptr)) {
  if (device_ == nullptr)
    throw Error(ErrorKind::kInputOutput, "Embree", "cannot start", "a CPU with SSE2 and libembree3");
  rtcSetDeviceMemoryMonitorFunction(device_, count_memory, &bytes_);
}

Device::~Device() { rtcReleaseDevice(device_); }

void Device::check(const char* step) const {
  const RTCError error = rtcGetDeviceError(device_);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorKind::kLimitExceeded, "Embree", std::string("out of memory at: ") + step,
                "a smaller forest or more memory");
  throw Error(ErrorKind::kInputOutput, "Embree",
              "error " + std::to_string(static_cast<int>(error)) + " at: " + step, "report this scene");
}

void commit(const Device& device, RTCScene scene, const RunControl& control) {
  control.check();
  const auto go_on = [](void* with, double) {
    return !static_cast<const RunControl*>(with)->stop.stop_requested();
  };
  rtcSetSceneProgressMonitorFunction(scene, go_on, const_cast<RunControl*>(&control));
  rtcCommitScene(scene);
  control.check();
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  device.check("building the scene");
}

void add_figures(const Target& to, const Prototype& prototype, PrototypeScene& out) {
  sort_elements_by_shape(prototype, out);
  add_quads(to, prototype, out);
  add_discs(to, prototype, out);
  if (to.options.shoots == ShootForm::kNeedles)
    add_needles(to, prototype, out);
  else if (to.options.shoots == ShootForm::kBough)
    add_boughs(to, prototype, out);
  else
    add_shoots(to, prototype, out);
  add_wood_cones(to, prototype, out);
  add_wood_triangles(to, prototype, out);
}

void build_prototype_scene(const Device& device, const Prototype& prototype, const RayScene::Options& options,
                           PrototypeScene& out, const RunControl& control) {
  SUNFLECK_EXPECTS(out.scene == nullptr);
  if (is_empty(prototype)) return;
  out.scene.reset(rtcNewScene(device.get()));
  add_figures({device, out.scene.get(), 0, {}, options}, prototype, out);
  commit(device, out.scene.get(), control);
}

}  // namespace sunfleck::trace
