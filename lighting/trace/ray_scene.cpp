#include "lighting/trace/ray_scene.h"

#include <embree3/rtcore.h>

#include <bit>
#include <cmath>
#include <limits>

#include "lighting/trace/embree_scene.h"
#include "lighting/trace/instance_table.h"
#include "lighting/trace/ray_walk.h"
#include "lighting/trace/scene_copies.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {

using namespace trace;

namespace {

// All trees as rays of one cast meet them.
struct PlacedTrees {
  std::vector<SceneCopy> copies;       // none where there is a table
  bool flat = false;                   // every copy is written out
  std::vector<PrototypeScene> placed;  // then the figures of each
  InstanceTable table;                 // of very many trees that do not repeat
  SceneHandle top;

  SceneCopy copy_met(const RTCHit& hit) const {
    if (!table.rows.empty()) return copy_in_table(table, hit.instID[0]);
    return copies[flat ? hit.geomID / kSlots : hit.instID[0]];
  }
};

}  // namespace

struct RayScene::State {
  Device device;
  Vec3 centre_m{0};
  Surroundings around;
  std::vector<PrototypeScene> figures;  // of each prototype; none where all are flat
  std::vector<PlacedTrees> casts;       // at least one; a table stays where it is
  std::size_t wrapped_copies = 0;
  bool has_shoots = false;

  State(const Forest& forest, const Options& options, const RunControl& control);
  void build(const Forest& forest, const Options& options, const RunControl& control);
  void build_prototypes(const Forest& forest, const Options& options, const RunControl& control);
  void place(const Forest& forest, const Options& options, PlacedTrees& trees, const RunControl& control);
  void place_in_table(const Forest& forest, const std::vector<PrototypeId>& prototypes, PlacedTrees& trees,
                      const RunControl& control);
  // In the scene's coordinates. A ray from the ground starts a hair below it, so that it meets what lies
  // there.
  Vec3 start_of(const Vec3& origin_m, const RayStart& from) const {
    const double sink_m = from.kind == HitKind::kGround ? 2.0 * around.rounding_m : 0.0;
    return origin_m - centre_m - Vec3(0, 0, sink_m);
  }
};

namespace {

Vec3 centre_of(const Forest& forest, const Box& coordinates) {
  const Box bounds = coordinates.empty() ? forest_bounds(forest) : coordinates;
  Vec3 centre = bounds.empty() ? Vec3(0, 0, forest.terrain.elevation_m) : bounds.centre();
  if (!forest.period) return centre;
  const Vec2 middle = forest.period->origin_m + 0.5 * forest.period->size_m;
  // Along the ground, so that heights above it stay.
  const double lift =
      forest.terrain.height_at(middle.x, middle.y) - forest.terrain.height_at(centre.x, centre.y);
  return {middle.x, middle.y, centre.z + lift};
}

// Writing out pays where a figure is worth more rays than it takes to build. A forest of one tree is written
// out as fast as it is built. Needles are too many to be written out for every tree.
bool is_flat_better(std::size_t figures, std::size_t copies, std::size_t instances,
                    const RayScene::Options& options) {
  constexpr std::size_t kMostFigures = 4000000, kMostCopies = 100000;
  constexpr double kFewestRaysPerFigure = 16.0;
  if (copies == 1 && instances == 1) return true;
  if (options.shoots == ShootForm::kNeedles) return false;
  const double expected_rays = options.casts.empty() ? options.expected_rays : 0.0;
  return figures <= kMostFigures && copies <= kMostCopies &&
         expected_rays >= kFewestRaysPerFigure * static_cast<double>(figures);
}

std::uint64_t key_of(const Vec3& origin, const Vec3& direction) {
  std::uint64_t key = 0;
  for (const double x : {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z})
    key = mix_seed(key, std::bit_cast<std::uint64_t>(x));
  return key;
}

// No copies: each instance is one.
RayContext context_for(const std::vector<SceneCopy>& copies, const RayStart& from,
                       std::uint32_t passed_instance) {
  RayContext context;
  rtcInitIntersectContext(&context.embree);
  context.copies = copies.empty() ? nullptr : copies.data();
  context.from = from;
  context.passed_instance = passed_instance;
  return context;
}

RTCRay embree_ray(const Piece& piece, const Vec3& direction) {
  RTCRay ray;
  ray.org_x = static_cast<float>(piece.origin.x);
  ray.org_y = static_cast<float>(piece.origin.y);
  ray.org_z = static_cast<float>(piece.origin.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tnear = static_cast<float>(piece.near_m);
  ray.tfar = static_cast<float>(piece.far_m);
  ray.time = 0.0f;
  ray.mask = 0xFFFFFFFFu;
  ray.id = 0;
  ray.flags = 0;
  return ray;
}

Vec3 turned(const SceneCopy& copy, const Vec3& v) {
  return {copy.cos_yaw * v.x - copy.sin_yaw * v.y, copy.sin_yaw * v.x + copy.cos_yaw * v.y, v.z};
}

// A needle met by a ray is turned any way, but seen in proportion to the cosine.
void set_needle(std::uint64_t lot, const Vec3& direction, RayHit& hit) {
  RandomStream stream(lot, 0, RandomPurpose::kFreeFlight);
  hit.front = stream.below(2) == 0;
  const double cos2 = stream.uniform(), turn = 2.0 * kPi * stream.uniform();
  const Basis around = basis_around(-direction);
  const double across = std::sqrt(1.0 - cos2);
  hit.normal = across * (std::cos(turn) * around.tangent + std::sin(turn) * around.bitangent) -
               std::sqrt(cos2) * direction;
}

// A needle along `axis` as the ray sees it: its normals in proportion to their cosine.
void set_side_of_needle(std::uint64_t lot, const Vec3& axis, const Vec3& direction, RayHit& hit) {
  RandomStream stream(lot, 0, RandomPurpose::kFreeFlight);
  hit.front = stream.below(2) == 0;
  const Vec3 towards = glm::dot(direction, axis) * axis - direction;
  const double sine = glm::length(towards);
  const double across = 2.0 * stream.uniform() - 1.0;
  hit.normal = sine > 1e-9 ? std::sqrt(1.0 - across * across) * towards / sine +
                                 across * glm::cross(axis, towards / sine)
                           : -direction;
}

void set_surface(const RTCHit& from, const SceneCopy& copy, const Vec3& direction, RayHit& hit) {
  const Vec3 n(from.Ng_x, from.Ng_y, from.Ng_z);
  const Vec3 there = turned(copy, n);
  const double length = glm::length(there);
  hit.front = glm::dot(there, direction) < 0.0;
  hit.normal = length > 0.0 ? there / (hit.front ? length : -length) : -direction;
}

RayHit described(const RTCRayHit& from, const SceneCopy& copy, const Piece& piece, const Vec3& direction,
                 std::uint64_t ray_key) {
  const unsigned slot = from.hit.geomID % kSlots;
  RayHit hit;
  hit.instance = copy.instance;
  hit.local = from.hit.primID;
  hit.distance_m = piece.before_m + from.ray.tfar;
  hit.position_m = piece.origin + static_cast<double>(from.ray.tfar) * direction;
  switch (slot) {
    case kQuads:
    case kDiscs: {
      const auto& elements = slot == kQuads ? copy.figures->quad_elements : copy.figures->disc_elements;
      hit.kind = HitKind::kFoliage;
      hit.local = elements[from.hit.primID];
      break;
    }
    case kShoots:
      hit.kind = HitKind::kFoliage;
      hit.local = copy.figures->shoot_elements[from.hit.primID];
      if (copy.figures->boughs.empty()) {
        set_needle(mix_seed(ray_key, hit.local), direction, hit);
      } else {
        hit.needle = RayHit::kSomeNeedle;
        const Vec3 axis(from.hit.Ng_x, from.hit.Ng_y, from.hit.Ng_z);
        set_side_of_needle(mix_seed(ray_key, hit.local), glm::normalize(turned(copy, axis)), direction, hit);
      }
      return hit;
    case kNeedles: {
      const NeedlePlace place = needle_place(*copy.figures, from.hit.primID);
      hit.kind = HitKind::kFoliage;
      hit.local = copy.figures->shoot_elements[place.shoot];
      hit.needle = place.needle;
      set_surface(from.hit, copy, direction, hit);
      // Either face by lot, as all needles have both.
      hit.front = (mix_seed(std::bit_cast<std::uint32_t>(from.ray.tfar), from.hit.primID) & 1) == 0;
      return hit;
    }
    default:
      hit.kind = slot == kWoodCones ? HitKind::kWood : HitKind::kWoodMesh;
  }
  set_surface(from.hit, copy, direction, hit);
  return hit;
}

RayHit ended(const RayEnd& end, const Surroundings& around, const Vec3& ground_normal, const Vec3& origin,
             const Vec3& direction) {
  RayHit hit;
  hit.distance_m = end.distance_m;
  hit.normal = -direction;
  hit.position_m = origin;
  if (end.kind == RayEnd::kSky) {
    hit.distance_m = std::numeric_limits<double>::infinity();
    return hit;
  }
  hit.kind = HitKind::kGround;
  hit.front = end.kind == RayEnd::kGround;
  hit.normal = hit.front ? ground_normal : -ground_normal;
  hit.position_m = origin + end.distance_m * direction;
  if (around.periodic)
    hit.position_m = into_base_cell(around, hit.position_m, cell_of(around, hit.position_m));
  hit.position_m.z -= around.height_above_ground(hit.position_m);
  return hit;
}

}  // namespace

RayScene::State::State(const Forest& forest, const Options& options, const RunControl& control) {
  centre_m = centre_of(forest, options.coordinates);
  around = surroundings_of(forest, options, centre_m);
  build(forest, options, control);
  const auto by_lot = [](const PrototypeScene& f) { return !f.shoots.empty() || !f.boughs.empty(); };
  has_shoots = std::any_of(figures.begin(), figures.end(), by_lot);
  for (const PlacedTrees& trees : casts)
    has_shoots = has_shoots || std::any_of(trees.placed.begin(), trees.placed.end(), by_lot);
}

void RayScene::State::build_prototypes(const Forest& forest, const Options& options,
                                       const RunControl& control) {
  figures.resize(forest.prototypes.size());
  for (std::size_t i = 0; i < figures.size(); ++i)
    build_prototype_scene(device, forest.prototypes[i], options, figures[i], control);
}

// Copies are set; the figures of all prototypes are built unless the copies are written out.
void RayScene::State::place(const Forest& forest, const Options& options, PlacedTrees& trees,
                            const RunControl& control) {
  trees.top = trees.flat ? build_flat_scene(device, forest, trees.copies, trees.placed, around, centre_m,
                                            options, control)
                         : build_top_scene(device, forest, trees.copies, figures, around, centre_m, control);
}

void RayScene::State::place_in_table(const Forest& forest, const std::vector<PrototypeId>& prototypes,
                                     PlacedTrees& trees, const RunControl& control) {
  trees.table = make_instance_table(forest, figures, prototypes, centre_m);
  trees.top = build_table_scene(device, trees.table, control);
}

void RayScene::State::build(const Forest& forest, const Options& options, const RunControl& control) {
  casts.resize(std::max<std::size_t>(1, options.casts.size()));
  if (!around.periodic && forest.instances.size() >= options.table_from) {
    build_prototypes(forest, options, control);
    for (std::size_t c = 0; c < casts.size(); ++c)
      place_in_table(forest, options.casts.empty() ? std::vector<PrototypeId>{} : options.casts[c], casts[c],
                     control);
    return;
  }
  bool all_flat = true;
  for (std::size_t c = 0; c < casts.size(); ++c) {
    PlacedTrees& trees = casts[c];
    trees.copies = copies_of(forest, options.casts.empty() ? own_prototypes(forest) : options.casts[c],
                             around, centre_m);
    trees.flat = is_flat_better(figures_of(forest, trees.copies), trees.copies.size(),
                                forest.instances.size(), options);
    all_flat = all_flat && trees.flat;
  }
  if (!all_flat) build_prototypes(forest, options, control);
  for (PlacedTrees& trees : casts) place(forest, options, trees, control);
  for (const SceneCopy& copy : casts[0].copies) wrapped_copies += copy.shift == Cell{} ? 0 : 1;
}

RayScene::RayScene(const Forest& forest, const Options& options, const RunControl& control)
    : state_(std::make_unique<State>(forest, options, control)) {}
RayScene::~RayScene() = default;

struct RayScene::Way {
  Vec3 origin_m, direction;
  double min_m = 0, max_m = std::numeric_limits<double>::infinity();
  RayStart from;
  std::uint32_t passed_instance = RayContext::kNoInstance;
};

RayHit RayScene::closest_hit(const Vec3& origin_m, const Vec3& direction, double min_distance_m,
                             const RayStart& from) const {
  return closest_on({.origin_m = origin_m, .direction = direction, .min_m = min_distance_m, .from = from});
}

RayHit RayScene::closest_hit_past(std::uint32_t instance, const Vec3& origin_m, const Vec3& direction,
                                  const RayStart& from, double max_m) const {
  return closest_on({.origin_m = origin_m,
                     .direction = direction,
                     .max_m = max_m,
                     .from = from,
                     .passed_instance = instance});
}

bool RayScene::occluded(const Vec3& origin_m, const Vec3& direction, double min_distance_m,
                        const RayStart& from) const {
  return occluded_on({.origin_m = origin_m, .direction = direction, .min_m = min_distance_m, .from = from});
}

bool RayScene::occluded_past(std::uint32_t instance, const Vec3& origin_m, const Vec3& direction,
                             const RayStart& from) const {
  return occluded_on(
      {.origin_m = origin_m, .direction = direction, .from = from, .passed_instance = instance});
}

RayHit RayScene::closest_on(const Way& way) const {
  const Vec3& direction = way.direction;
  SUNFLECK_EXPECTS(std::abs(glm::dot(direction, direction) - 1.0) < 1e-6);
  const State& s = *state_;
  SUNFLECK_EXPECTS(way.from.cast < s.casts.size());
  const PlacedTrees& trees = s.casts[way.from.cast];
  const Vec3 origin = s.start_of(way.origin_m, way.from);
  RayContext context = context_for(trees.copies, way.from, way.passed_instance);
  RTCRayHit found;
  RayHit hit;
  const RayEnd end = walk(s.around, origin, direction, way.min_m, [&](Piece piece) {
    piece.far_m = std::min(piece.far_m, way.max_m - piece.before_m);
    if (piece.far_m <= piece.near_m) return false;
    context.cell = piece.cell;
    if (s.has_shoots) context.ray_key = key_of(piece.origin, direction);
    found.ray = embree_ray(piece, direction);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(trees.top.get(), &context.embree, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    const SceneCopy copy = trees.copy_met(found.hit);
    hit = described(found, copy, piece, direction, context.ray_key);
    hit.on_original_m = into_base_cell(s.around, hit.position_m, copy.shift);
    return true;
  });
  if (end.kind != RayEnd::kStopped) {
    const Vec3 up = glm::normalize(Vec3(-s.around.ground_rise.x, -s.around.ground_rise.y, 1.0));
    hit = ended(end, s.around, up, origin, direction);
    hit.on_original_m = hit.position_m;
  }
  hit.cast = way.from.cast;
  hit.position_m += s.centre_m;
  hit.on_original_m += s.centre_m;
  return hit;
}

bool RayScene::occluded_on(const Way& way) const {
  const Vec3& direction = way.direction;
  SUNFLECK_EXPECTS(std::abs(glm::dot(direction, direction) - 1.0) < 1e-6);
  const State& s = *state_;
  SUNFLECK_EXPECTS(way.from.cast < s.casts.size());
  const PlacedTrees& trees = s.casts[way.from.cast];
  const Vec3 origin = s.start_of(way.origin_m, way.from);
  RayContext context = context_for(trees.copies, way.from, way.passed_instance);
  const RayEnd end = walk(s.around, origin, direction, way.min_m, [&](const Piece& piece) {
    context.cell = piece.cell;
    if (s.has_shoots) context.ray_key = key_of(piece.origin, direction);
    RTCRay ray = embree_ray(piece, direction);
    rtcOccluded1(trees.top.get(), &context.embree, &ray);
    return ray.tfar < 0.0f;
  });
  return end.kind != RayEnd::kSky;
}

std::size_t RayScene::copies() const { return state_->wrapped_copies; }
std::size_t RayScene::memory_bytes() const {
  const State& s = *state_;
  std::size_t bytes = s.device.bytes();
  for (const PlacedTrees& trees : s.casts)
    bytes += trees.copies.size() * sizeof(SceneCopy) + trees.table.rows.size() * sizeof(TreeRow) +
             trees.table.prototypes.size() * sizeof(PrototypeId);
  return bytes;
}

}  // namespace sunfleck
