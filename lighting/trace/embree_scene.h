// Embree's side of a RayScene: one scene per prototype in tree coordinates, one scene of instances in world
// coordinates moved by `centre_m` so that single precision loses nothing far from the world's origin.
// Private to this folder. Embree is seen in .cpp files only: include <embree3/rtcore.h> before this header.
#pragma once

#ifndef RTC_VERSION
#error "include <embree3/rtcore.h> first"
#endif

#include <atomic>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "lighting/trace/ray_scene.h"
#include "lighting/trace/solids.h"

namespace sunfleck::trace {

// Geometry ids inside a prototype's scene.
enum Slot : unsigned { kQuads, kDiscs, kShoots, kWoodCones, kWoodTriangles };

struct ShootVolume {
  Cylinder cylinder;
  double extinction_per_m = 0;  // half the one-sided needle area per volume
};

struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

struct PrototypeScene {
  SceneHandle scene;  // null where there is nothing to hit
  std::vector<std::uint32_t> quad_elements, disc_elements, shoot_elements;  // Embree primitive -> element
  std::vector<ShootVolume> shoots;
  std::vector<ConeFrustum> cones;
};

// Which copy of the period an object belongs to: whole cells from the base cell.
struct Cell {
  std::int32_t x = 0, y = 0;
  bool operator==(const Cell&) const = default;
};

// One placement of a prototype, as Embree's instance of the same number.
struct SceneCopy {
  std::uint32_t instance = 0;
  Cell shift;
  const PrototypeScene* prototype = nullptr;
  double cos_yaw = 1, sin_yaw = 0;
};

// What the callbacks need to know of a ray; Embree hands it through.
struct RayContext {
  RTCIntersectContext embree;  // first: Embree's pointer to it is a pointer to all
  const SceneCopy* copies = nullptr;
  RayStart from;
  Cell cell;  // the cell of the period that the ray is in
  std::uint64_t ray_key = 0;
};

// True if the hit lies on the surface the ray starts from, in that very copy.
bool is_start(const RayContext& context, unsigned copy, HitKind kind, std::uint32_t local);

class Device {
 public:
  Device();
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  RTCDevice get() const { return device_; }
  std::size_t bytes() const { return static_cast<std::size_t>(bytes_.load()); }
  void check(const char* step) const;  // throws Error if Embree reported a failure

 private:
  RTCDevice device_;
  std::atomic<std::int64_t> bytes_{0};
};

// Commits a scene; throws Error(kCancelled) when stopped on the way.
void commit(const Device& device, RTCScene scene, const RunControl& control);

// Fills `out` and commits its scene; `out` must stay where it is.
void build_prototype_scene(const Device& device, const Prototype& prototype, PrototypeScene& out,
                           const RunControl& control);
// Adds the callbacks of shoots and wood (embree_solids.cpp).
void add_shoots(const Device& device, const Prototype& prototype, PrototypeScene& out);
void add_wood_cones(const Device& device, const Prototype& prototype, PrototypeScene& out);

}  // namespace sunfleck::trace
