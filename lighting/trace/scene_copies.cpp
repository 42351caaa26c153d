#include <embree3/rtcore.h>

#include "lighting/trace/scene_copies.h"

#include <array>
#include <span>

namespace sunfleck::trace {
namespace {

std::array<Vec3, 8> placed_corners(const Instance& instance, const Box& box, const Vec3& centre_m) {
  std::array<Vec3, 8> corners;
  for (unsigned k = 0; k < 8; ++k)
    corners[k] = world_from_tree(instance, {k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y,
                                            k & 4 ? box.hi.z : box.lo.z}) -
                 centre_m;
  return corners;
}

Box box_around(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& p : points) box.include(p);
  return box;
}

std::vector<Box> prototype_boxes(const Forest& forest) {
  std::vector<Box> boxes;
  for (const Prototype& p : forest.prototypes) boxes.push_back(prototype_bounds(p));
  return boxes;
}

Vec3 place_of(const Instance& instance, const SceneCopy& copy, const Surroundings& around,
              const Vec3& centre_m) {
  return into_base_cell(around, instance.position_m - centre_m, {-copy.shift.x, -copy.shift.y});
}

// All shifts by whole cells that bring the interval [lo, hi] into touch with the base cell.
struct Shifts {
  std::int32_t first, last;
};
Shifts shifts_into(double cell_lo, double cell_size, double lo, double hi, double touch) {
  return {static_cast<std::int32_t>(std::ceil((cell_lo - touch - hi) / cell_size)),
          static_cast<std::int32_t>(std::floor((cell_lo + cell_size + touch - lo) / cell_size))};
}

void set_transform(RTCGeometry geometry, const Instance& instance, const SceneCopy& copy,
                   const Surroundings& around, const Vec3& centre_m) {
  const Vec3 at = place_of(instance, copy, around, centre_m);
  const double s = instance.scale;
  const std::array<double, 12> columns = {s * copy.cos_yaw,
                                          s * copy.sin_yaw,
                                          0,
                                          -s * copy.sin_yaw,
                                          s * copy.cos_yaw,
                                          0,
                                          0,
                                          0,
                                          s,
                                          at.x,
                                          at.y,
                                          at.z};
  std::array<float, 12> matrix;
  for (std::size_t i = 0; i < columns.size(); ++i) matrix[i] = static_cast<float>(columns[i]);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
}

// Heights above the ground between which objects lie, and their largest coordinate.
struct Occupied {
  double lowest_m = 0, highest_m = 0, reach_m = 0;
};
Occupied occupied(const Forest& forest, const std::vector<std::vector<PrototypeId>>& casts,
                  const Surroundings& around, const Vec3& centre_m) {
  const std::vector<Box> boxes = prototype_boxes(forest);
  Box heights;  // x: heights; y, z unused
  double reach_m = 0.0;
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& instance = forest.instances[i];
    Box box = casts.empty() ? boxes[instance.prototype.value] : Box{};
    for (const std::vector<PrototypeId>& cast : casts) {
      const Box& other = boxes[cast[i].value];
      if (!other.empty()) box.include(other.lo), box.include(other.hi);
    }
    if (box.empty()) continue;
    for (const Vec3& p : placed_corners(instance, box, centre_m)) {
      heights.include({around.height_above_ground(p), 0, 0});
      reach_m = std::max({reach_m, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
  }
  if (heights.empty()) return {};
  return {heights.lo.x, heights.hi.x, reach_m};
}

void add_wrapped_copies(const SceneCopy& base, const Instance& instance, const Box& local,
                        const Surroundings& around, const Vec3& centre_m, std::vector<SceneCopy>& copies) {
  const auto corners = placed_corners(instance, local, centre_m);
  const Box box = box_around(corners);
  const double touch = 2.0 * around.rounding_m;
  const Shifts xs = shifts_into(around.cell_lo.x, around.cell_size.x, box.lo.x, box.hi.x, touch);
  const Shifts ys = shifts_into(around.cell_lo.y, around.cell_size.y, box.lo.y, box.hi.y, touch);
  for (std::int32_t x = xs.first; x <= xs.last; ++x)
    for (std::int32_t y = ys.first; y <= ys.last; ++y)
      copies.push_back({base.instance, {x, y}, base.prototype});
}

}  // namespace

Surroundings surroundings_of(const Forest& forest, const RayScene::Options& options, const Vec3& centre_m) {
  Surroundings s;
  s.ground = options.ground;
  s.max_wraps = options.max_wraps;
  s.ground_at_centre_m = forest.terrain.height_at(centre_m.x, centre_m.y) - centre_m.z;
  const Vec3 normal = forest.terrain.normal();
  s.ground_rise = {-normal.x / normal.z, -normal.y / normal.z};
  if (forest.period) {
    s.periodic = true;
    s.cell_lo = forest.period->origin_m - Vec2(centre_m);
    s.cell_size = forest.period->size_m;
  }
  const Occupied space = occupied(forest, options.casts, s, centre_m);
  const double width_m = s.periodic ? std::max(s.cell_size.x, s.cell_size.y) : space.reach_m;
  const Vec3 stated = options.coordinates.size();
  s.rounding_m = 4e-7 * (options.coordinates.empty() ? std::max(width_m, space.highest_m - space.lowest_m)
                                                     : std::max({stated.x, stated.y, stated.z}));
  s.floor_m = space.lowest_m - s.rounding_m;
  s.ceiling_m = space.highest_m + s.rounding_m;
  return s;
}

std::vector<PrototypeId> own_prototypes(const Forest& forest) {
  std::vector<PrototypeId> own;
  own.reserve(forest.instances.size());
  for (const Instance& instance : forest.instances) own.push_back(instance.prototype);
  return own;
}

std::vector<SceneCopy> copies_of(const Forest& forest, std::span<const PrototypeId> cast,
                                 const Surroundings& around, const Vec3& centre_m) {
  const std::vector<Box> boxes = prototype_boxes(forest);
  std::vector<SceneCopy> copies;
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const SceneCopy base{static_cast<std::uint32_t>(i), {}, cast[i]};
    const Box& local = boxes[cast[i].value];
    if (is_empty(forest.prototypes[cast[i].value]) || local.empty()) continue;
    if (around.periodic)
      add_wrapped_copies(base, forest.instances[i], local, around, centre_m, copies);
    else
      copies.push_back(base);
  }
  return copies;
}

std::size_t figures_of(const Forest& forest, const std::vector<SceneCopy>& copies) {
  std::size_t figures = 0;
  for (const SceneCopy& copy : copies) {
    const Prototype& p = forest.prototypes[copy.prototype.value];
    figures += p.foliage.size() + p.wood.size() + p.wood_mesh.size();
  }
  return figures;
}

SceneHandle build_flat_scene(const Device& device, const Forest& forest, std::vector<SceneCopy>& copies,
                             std::vector<PrototypeScene>& placed, const Surroundings& around,
                             const Vec3& centre_m, const RayScene::Options& options,
                             const RunControl& control) {
  SceneHandle scene(rtcNewScene(device.get()));
  placed.resize(copies.size());
  for (unsigned i = 0; i < copies.size(); ++i) {
    control.check();
    const Instance& instance = forest.instances[copies[i].instance];
    const Vec3 moved_by = place_of(instance, copies[i], around, centre_m) - instance.position_m;
    placed[i].copy = i;
    copies[i].figures = &placed[i];
    add_figures({device, scene.get(), i * kSlots, {&instance, moved_by}, options},
                forest.prototypes[copies[i].prototype.value], placed[i]);
  }
  commit(device, scene.get(), control);
  return scene;
}

SceneHandle build_top_scene(const Device& device, const Forest& forest, std::vector<SceneCopy>& copies,
                            const std::vector<PrototypeScene>& prototypes, const Surroundings& around,
                            const Vec3& centre_m, const RunControl& control) {
  SceneHandle scene(rtcNewScene(device.get()));
  for (std::size_t i = 0; i < copies.size() && !control.stop.stop_requested(); ++i) {
    const Instance& instance = forest.instances[copies[i].instance];
    copies[i].figures = &prototypes[copies[i].prototype.value];
    copies[i].cos_yaw = std::cos(static_cast<double>(instance.yaw_rad));
    copies[i].sin_yaw = std::sin(static_cast<double>(instance.yaw_rad));
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, copies[i].figures->scene.get());
    set_transform(geometry, instance, copies[i], around, centre_m);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene.get(), geometry, static_cast<unsigned>(i));
    rtcReleaseGeometry(geometry);
  }
  commit(device, scene.get(), control);
  return scene;
}

}  // namespace sunfleck::trace
