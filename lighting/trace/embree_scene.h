// Embree's side of a RayScene: one scene per prototype in tree coordinates and one scene of instances, or one
// scene of all trees written out; coordinates of the scene are the world's moved by `centre_m` so that single
// precision loses nothing far from the world's origin.
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

#include "lighting/shade/shoot_bough.h"
#include "lighting/trace/ray_scene.h"
#include "lighting/trace/solids.h"

namespace sunfleck::trace {

// Geometry ids inside a prototype's scene; where trees are written out, of copy number c: c * kSlots + slot.
enum Slot : unsigned { kQuads, kDiscs, kShoots, kNeedles, kWoodCones, kWoodTriangles, kSlots };

// From tree coordinates to those of an Embree scene.
struct Placement {
  const Instance* instance = nullptr;  // none: they are the same
  Vec3 moved_by{0};
  Vec3 point(const Vec3& p) const {
    return instance != nullptr ? world_from_tree(*instance, p) + moved_by : p;
  }
  Vec3 direction(const Vec3& d) const {
    return instance != nullptr ? world_direction_from_tree(*instance, d) : d;
  }
  double scale() const { return instance != nullptr ? static_cast<double>(instance->scale) : 1.0; }
};

struct ShootVolume {
  Cylinder cylinder;
  double extinction_per_m = 0;  // half the one-sided needle area per volume
};

struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

// The figures of a tree: of a prototype, for all its instances, or of one copy written out.
struct PrototypeScene {
  static constexpr unsigned kManyCopies = 0xFFFFFFFFu;
  SceneHandle scene;  // of a prototype; null where there is nothing to hit
  unsigned copy = kManyCopies;
  std::vector<std::uint32_t> quad_elements, disc_elements, shoot_elements;  // Embree primitive -> element
  std::vector<ShootVolume> shoots;
  std::vector<ShootBough> boughs;            // instead of them
  std::vector<std::uint32_t> needles_up_to;  // of the first shoot, the first two, ... where drawn one by one
  std::vector<ConeFrustum> cones;
};

// Which copy of the period an object belongs to: whole cells from the base cell.
struct Cell {
  std::int32_t x = 0, y = 0;
  bool operator==(const Cell&) const = default;
};

// One placement of a prototype, as Embree's instance of the same number or written out. The turn is what is
// left to do to the normals of hits.
struct SceneCopy {
  std::uint32_t instance = 0;
  Cell shift;
  PrototypeId prototype{};
  const PrototypeScene* figures = nullptr;
  double cos_yaw = 1, sin_yaw = 0;
};

// What the callbacks need to know of a ray; Embree hands it through.
struct RayContext {
  RTCIntersectContext embree;         // first: Embree's pointer to it is a pointer to all
  const SceneCopy* copies = nullptr;  // null: each instance is one copy (instance_table.h)
  RayStart from;
  Cell cell;  // the cell of the period that the ray is in
  std::uint64_t ray_key = 0;
  std::uint32_t passed_instance = kNoInstance;  // the ray goes through it as if it were not there

  static constexpr std::uint32_t kNoInstance = 0xFFFFFFFFu;
};

// The copy that a figure belongs to.
inline unsigned copy_met(const PrototypeScene& figures, unsigned embree_instance) {
  return figures.copy == PrototypeScene::kManyCopies ? embree_instance : figures.copy;
}

// Which instance a copy is, and in which cell.
struct PlacedInstance {
  std::uint32_t instance;
  Cell shift;
};
inline PlacedInstance placed_instance(const RayContext& context, unsigned copy) {
  if (context.copies == nullptr) return {copy, {}};
  return {context.copies[copy].instance, context.copies[copy].shift};
}

// The shoot of `shoot_elements` that a needle belongs to, and which of its needles that is.
struct NeedlePlace {
  std::size_t shoot;
  std::uint32_t needle;
};
NeedlePlace needle_place(const PrototypeScene& prototype, unsigned primitive);

// True if the hit lies on the surface the ray starts from, in that very copy.
bool is_start(const RayContext& context, unsigned copy, HitKind kind, std::uint32_t local);

// True if the copy is the very instance that the ray passes, not one of its other periods.
inline bool is_passed(const RayContext& context, unsigned copy) {
  if (context.passed_instance == RayContext::kNoInstance) return false;
  const PlacedInstance c = placed_instance(context, copy);
  return c.instance == context.passed_instance && c.shift.x + context.cell.x == 0 &&
         c.shift.y + context.cell.y == 0;
}

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

bool is_empty(const Prototype& prototype);

// Commits a scene; throws Error(kCancelled) when stopped on the way.
void commit(const Device& device, RTCScene scene, const RunControl& control);

// Fills `out` and commits its scene; `out` must stay where it is.
void build_prototype_scene(const Device& device, const Prototype& prototype, const RayScene::Options& options,
                           PrototypeScene& out, const RunControl& control);

// Adds the figures of a tree to a scene, as geometries first_id + slot; `out` takes what the callbacks need.
struct Target {
  const Device& device;
  RTCScene scene;
  unsigned first_id = 0;
  Placement placement;
  const RayScene::Options& options;
};
void add_figures(const Target& to, const Prototype& prototype, PrototypeScene& out);
// Shoots and wood of them (embree_solids.cpp), needles (embree_needles.cpp) and boughs (embree_boughs.cpp).
void add_shoots(const Target& to, const Prototype& prototype, PrototypeScene& out);
void add_needles(const Target& to, const Prototype& prototype, PrototypeScene& out);
void add_boughs(const Target& to, const Prototype& prototype, PrototypeScene& out);

// What the options say of the needles of an element; throws Error(kInvalidInput) where they say nothing.
const FoliageTemplate& needles_of_element(const RayScene::Options& options, const Prototype& prototype,
                                          std::uint32_t element);

struct Callbacks {
  RTCBoundsFunction bounds;
  RTCIntersectFunctionN intersect;
  RTCOccludedFunctionN occluded;
};
void attach_solids(const Target& to, PrototypeScene& out, Slot slot, std::size_t count,
                   const Callbacks& callbacks);
void set_bounds(RTCBounds& to, const Box& box);  // a step of single precision wider
void write_hit(RTCRayHit& to, double t, const Vec3& normal, unsigned slot, unsigned primitive, unsigned copy);
// A number in [0, 1) of this ray and this shoot.
double lot_of(const RayContext& context, unsigned copy, unsigned primitive);
void add_wood_cones(const Target& to, const Prototype& prototype, PrototypeScene& out);

}  // namespace sunfleck::trace
