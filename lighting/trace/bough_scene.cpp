#include "lighting/trace/bough_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "lighting/shade/bough_light.h"
#include "lighting/shade/bough_quick.h"
#include "lighting/shade/bough_table.h"
#include "lighting/shade/shoot_bough.h"
#include "lighting/trace/embree_scene.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {

using namespace trace;

namespace {

// A bough in its tree, as rays need it.
struct BoughRow {
  Vec3f origin, side, up, axis;
  QuickBough bough;
  std::uint32_t kind = 0;  // its table
};

struct BoughTree {
  std::vector<BoughRow> rows;
  SceneHandle scene;
};

struct Placed {
  const BoughTree* tree = nullptr;
  float scale = 1;
};

Vec3f into(const BoughRow& b, const Vec3f& v) {
  return {glm::dot(v, b.side), glm::dot(v, b.up), glm::dot(v, b.axis)};
}

// Top of the bough: where its last whorl reaches the outer radius.
float top_of(const QuickBough& b) { return b.highest + b.outer_radius * b.cosine / b.sine; }

// What a ray met: kept unsorted while Embree finds them.
struct Crossing {
  float enter, leave, depth, z;  // z: of its middle, along the bough
  std::uint32_t instance, bough;
};

// Handed through Embree to the callbacks.
struct BoughContext {
  RTCIntersectContext embree;  // first
  const Placed* placed = nullptr;
  bool keep = false;  // crossings; else depth only
  float depth = 0;
  float enough = 6.5f;  // 1.5 in 1000 come through
  unsigned passed_instance = RTC_INVALID_GEOMETRY_ID, passed_bough = RTC_INVALID_GEOMETRY_ID;
  std::size_t count = 0;
  std::array<Crossing, 96> crossings;
};

void bough_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& tree = *static_cast<const BoughTree*>(args->geometryUserPtr);
  const BoughRow& b = tree.rows[args->primID];
  const Vec3f lo = b.origin + b.bough.lowest * b.axis, hi = b.origin + top_of(b.bough) * b.axis;
  const Vec3f wide = 1.00001f * b.bough.outer_radius * glm::sqrt(glm::max(Vec3f(0), 1.0f - b.axis * b.axis));
  const Vec3f low = glm::min(lo, hi) - wide, high = glm::max(lo, hi) + wide;
  RTCBounds& to = *args->bounds_o;
  to.lower_x = low.x, to.lower_y = low.y, to.lower_z = low.z;
  to.upper_x = high.x, to.upper_y = high.y, to.upper_z = high.z;
}

// Adds up what the bough does to the ray: never a hit. True where enough has been met.
bool add_bough(const BoughTree& tree, unsigned primitive, const RTCRay& ray, BoughContext& context) {
  const unsigned instance = context.embree.instID[0];
  if (primitive == context.passed_bough && instance == context.passed_instance) return false;
  const BoughRow& b = tree.rows[primitive];
  const float scale = context.placed[instance].scale;  // the ray's direction is as long as 1 / scale here
  const Vec3f origin = into(b, Vec3f(ray.org_x, ray.org_y, ray.org_z) - b.origin),
              d = into(b, scale * Vec3f(ray.dir_x, ray.dir_y, ray.dir_z));
  const QuickCrossing c = quick_crossing(b.bough, origin, d, ray.tnear / scale, ray.tfar / scale);
  if (!(c.depth > 0)) return false;
  context.depth += c.depth;
  if (context.keep && context.count < context.crossings.size())
    context.crossings[context.count++] = {c.enter * scale, c.leave * scale,
                                          c.depth,         origin.z + 0.5f * (c.enter + c.leave) * d.z,
                                          instance,        primitive};
  return context.depth > context.enough;
}

// Nearest first: once enough has been met, nothing beyond the last of it is asked for.
void bough_seen(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& context = *reinterpret_cast<BoughContext*>(args->context);
  auto& ray = reinterpret_cast<RTCRayHit*>(args->rayhit)->ray;
  if (!add_bough(*static_cast<const BoughTree*>(args->geometryUserPtr), args->primID, ray, context)) return;
  float last = 0;
  for (std::size_t i = 0; i < context.count; ++i) last = std::max(last, context.crossings[i].leave);
  ray.tfar = std::min(ray.tfar, last);
}

void bough_shades(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& context = *reinterpret_cast<BoughContext*>(args->context);
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  if (add_bough(*static_cast<const BoughTree*>(args->geometryUserPtr), args->primID, ray, context))
    ray.tfar = -std::numeric_limits<float>::infinity();
}

RTCRay ray_of(const Vec3& origin, const Vec3& direction, double far_m) {
  RTCRay ray;
  ray.org_x = static_cast<float>(origin.x), ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x), ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tnear = 0.0f, ray.tfar = static_cast<float>(std::min(far_m, 1e30));
  ray.time = 0.0f, ray.mask = 0xFFFFFFFFu, ray.id = 0, ray.flags = 0;
  return ray;
}

void check_place(const Instance& at, std::size_t i) {
  if (!is_finite(at.position_m) || !std::isfinite(at.yaw_rad) || !(at.scale > 0.0f && at.scale <= 1e6f))
    throw_invalid("forest.instances[" + std::to_string(i) + "]",
                  "has a position, turn or scale that is not a finite number above its bounds",
                  "finite places and scales in (0, 1e6]");
}

// Mean over the outline of a finite bough, by strips of its cylinder.
BoughLight whole_bough(const BoughVolume& v, const Vec3& to_viewer, const Vec3& to_light) {
  constexpr int kAcross = 6, kAlong = 8;
  const BoughDirection ray = bough_direction(v, -to_viewer), sun = bough_direction(v, to_light);
  const double top = v.highest + v.outer_radius * v.cos_aperture / v.sin_aperture,
               middle = 0.5 * (v.lowest + top);
  const double half = 0.5 * (top - v.lowest) * ray.sine + v.outer_radius * std::abs(ray.along.z);
  const Vec3 aside(ray.across.y, -ray.across.x, 0), upward = glm::cross(aside, ray.along);
  const double back = 2.0 * (top - v.lowest + v.outer_radius);
  BoughLight sum;
  for (int i = 0; i < kAcross; ++i)
    for (int j = 0; j < kAlong; ++j) {
      const double x = v.outer_radius * (2.0 * (i + 0.5) / kAcross - 1.0),
                   y = half * (2.0 * (j + 0.5) / kAlong - 1.0);
      const BoughLight one =
          bough_light(v, Vec3(0, 0, middle) + x * aside + y * upward - back * ray.along, ray, sun);
      sum.opacity += one.opacity;
      sum.reflected += one.reflected;
    }
  return sum;
}

constexpr int kTableRows = 13;

}  // namespace

struct BoughScene::State {
  const Forest& forest;
  Device device;
  Vec3 centre_m{0};
  std::vector<BoughTree> trees;  // of each prototype
  std::vector<Placed> placed;    // of each instance
  std::vector<BoughTable> tables;
  SceneHandle top;

  explicit State(const Forest& f) : forest(f) {}
  void add_trees(std::span<const NeedleKind> kinds, const RunControl& control);
  void add_instances(const RunControl& control);
  BoughContext context() const {
    BoughContext c;
    rtcInitIntersectContext(&c.embree);
    c.placed = placed.data();
    return c;
  }
  double depth(const Vec3& origin, const Vec3& direction, double far_m, BoughContext& c) const {
    RTCRay ray = ray_of(origin, direction, far_m);
    rtcOccluded1(top.get(), &c.embree, &ray);
    return static_cast<double>(c.depth);
  }
  void find_boughs(const Vec3& origin, const Vec3& direction, double far_m, BoughContext& c) const {
    c.keep = true;
    RTCRayHit ray;
    ray.ray = ray_of(origin, direction, far_m);
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(top.get(), &c.embree, &ray);
  }
};

// Kinds of bough: those of one species, lengths relative to the outer radius apart.
void BoughScene::State::add_trees(std::span<const NeedleKind> kinds, const RunControl& control) {
  std::map<std::array<long, 4>, std::uint32_t> known;
  trees.resize(forest.prototypes.size());
  for (std::size_t p = 0; p < trees.size(); ++p) {
    const Prototype& prototype = forest.prototypes[p];
    for (const FoliageElement& e : prototype.foliage) {
      if (e.shape != ElementShape::kShoot) continue;
      const std::string& material = prototype.materials[e.material];
      const NeedleKind* kind = find_needle_kind(kinds, material);
      if (kind == nullptr)
        throw_invalid("needles", "nothing is known of the needles of '" + material + "'",
                      "a species with shoots");
      const ShootBough b = shoot_bough(e, kind->foliage);
      const BoughVolume& v = b.volume;
      // Shapes that differ by less than a tenth share a table.
      const auto step = [](double x) { return std::lround(10.0 * std::log(std::max(x, 1e-9))); };
      const std::array<long, 4> shape{step(v.sin_aperture), step(v.highest / v.outer_radius), step(v.density),
                                      step(v.hot_spot_length / v.outer_radius)};
      const auto [at, added] = known.try_emplace(shape, static_cast<std::uint32_t>(tables.size()));
      if (added)
        tables.emplace_back(
            kTableRows, [&v](const Vec3& view, const Vec3& sun) { return whole_bough(v, view, sun); },
            control);
      trees[p].rows.push_back(
          {Vec3f(b.origin_m), Vec3f(b.side), Vec3f(b.up), Vec3f(b.axis), quick_bough(v), at->second});
    }
    if (trees[p].rows.empty()) continue;
    trees[p].scene.reset(rtcNewScene(device.get()));
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(trees[p].rows.size()));
    rtcSetGeometryUserData(geometry, &trees[p]);
    rtcSetGeometryBoundsFunction(geometry, bough_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, bough_seen);
    rtcSetGeometryOccludedFunction(geometry, bough_shades);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(trees[p].scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(trees[p].scene.get(), RTC_BUILD_QUALITY_HIGH);
    commit(device, trees[p].scene.get(), control);
  }
}

void BoughScene::State::add_instances(const RunControl& control) {
  top.reset(rtcNewScene(device.get()));
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& at = forest.instances[i];
    check_place(at, i);
    placed.push_back({&trees[at.prototype.value], at.scale});
    if (trees[at.prototype.value].rows.empty()) continue;
    const double c = at.scale * std::cos(static_cast<double>(at.yaw_rad)),
                 s = at.scale * std::sin(static_cast<double>(at.yaw_rad));
    const Vec3 p = at.position_m - centre_m;
    const std::array<double, 12> columns{c, s, 0, -s, c, 0, 0, 0, at.scale, p.x, p.y, p.z};
    std::array<float, 12> matrix;
    std::transform(columns.begin(), columns.end(), matrix.begin(),
                   [](double x) { return static_cast<float>(x); });
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, trees[at.prototype.value].scene.get());
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(top.get(), geometry, static_cast<unsigned>(i));
    rtcReleaseGeometry(geometry);
  }
  commit(device, top.get(), control);
}

BoughScene::BoughScene(const Forest& forest, std::span<const NeedleKind> kinds, const RunControl& control)
    : state_(std::make_unique<State>(forest)) {
  for (std::size_t i = 0; i < forest.instances.size(); ++i) check_place(forest.instances[i], i);
  const Box bounds = forest_bounds(forest);
  if (!bounds.empty()) state_->centre_m = bounds.centre();
  state_->add_trees(kinds, control);
  state_->add_instances(control);
}
BoughScene::~BoughScene() = default;

BoughScene::Lit::Lit(const BoughScene& scene, const Viewer& viewer, const Vec3& to_sun, int stations)
    : viewer_(viewer), to_sun_(to_sun), stations_(static_cast<std::size_t>(stations)) {
  SUNFLECK_EXPECTS(stations >= 1);
  std::size_t count = 0;
  for (const Placed& p : scene.state_->placed) {
    first_.push_back(count);
    count += p.tree->rows.size() * stations_;
  }
  reflected_ = std::make_unique<std::atomic<float>[]>(count);
  for (std::size_t i = 0; i < count; ++i) reflected_[i].store(-1.0f, std::memory_order_relaxed);
}

// What reaches a station through other boughs, from two places beside the axis, times what the bough makes of
// light from there.
float BoughScene::station(const Lit& lit, std::uint32_t instance, std::uint32_t bough, std::size_t k) const {
  std::atomic<float>& kept = lit.reflected_[lit.first_[instance] + bough * lit.stations_ + k];
  const float known = kept.load(std::memory_order_relaxed);
  if (known >= 0.0f) return known;
  const State& s = *state_;
  const Instance& at = s.forest.instances[instance];
  const BoughRow& b = s.placed[instance].tree->rows[bough];
  const auto world = [&](const Vec3f& p) { return world_from_tree(at, Vec3(p)) - s.centre_m; };
  const auto in_bough = [&](const Vec3& d) { return Vec3(into(b, Vec3f(tree_direction_from_world(at, d)))); };
  const float high = top_of(b.bough) - b.bough.lowest;
  const float z = b.bough.lowest + high * (static_cast<float>(k) + 0.5f) / static_cast<float>(lit.stations_);
  const Vec3f middle = b.origin + z * b.axis;
  const Vec3 to_viewer = lit.viewer_.far
                             ? -lit.viewer_.direction
                             : glm::normalize(lit.viewer_.position_m - s.centre_m - world(middle));
  const BoughLight whole = s.tables[b.kind].at(in_bough(to_viewer), in_bough(lit.to_sun_));
  BoughContext c = s.context();
  c.passed_instance = instance, c.passed_bough = bough;
  const double reaches = std::exp(-s.depth(world(middle), lit.to_sun_, 1e30, c));
  const float found = static_cast<float>(whole.opacity > 0 ? reaches * whole.reflected / whole.opacity : 0.0);
  kept.store(found, std::memory_order_relaxed);
  return found;
}

float BoughScene::light_at(const Lit& lit, std::uint32_t instance, std::uint32_t bough, float z) const {
  if (lit.stations_ == 1) return station(lit, instance, bough, 0);
  const QuickBough& b = state_->placed[instance].tree->rows[bough].bough;
  const float last = static_cast<float>(lit.stations_ - 1);
  const float at = std::clamp((z - b.lowest) / (top_of(b) - b.lowest) * (last + 1) - 0.5f, 0.0f, last);
  const auto low = std::min(static_cast<std::size_t>(at), lit.stations_ - 2);
  return std::lerp(station(lit, instance, bough, low), station(lit, instance, bough, low + 1),
                   at - static_cast<float>(low));
}

BoughScene::Seen BoughScene::seen(const Vec3& origin_m, const Vec3& direction, const Lit& lit,
                                  double far_m) const {
  constexpr float kHidden = 0.002f, kLittle = 0.03f;
  BoughContext c = state_->context();
  state_->find_boughs(origin_m - state_->centre_m, direction, far_m, c);
  Seen seen;
  const auto met = std::span(c.crossings).first(c.count);
  // Few: sorted by insertion.
  for (std::size_t i = 1; i < met.size(); ++i)
    for (std::size_t k = i; k > 0 && met[k].enter < met[k - 1].enter; --k) std::swap(met[k], met[k - 1]);
  for (const Crossing& m : met) {
    const float left = seen.through * lane_exp(-m.depth), share = seen.through - left;
    // Little of a bough is taken to be lit as those in front of it.
    seen.reflected +=
        share * (share > kLittle || !(seen.through < 0.5f) ? light_at(lit, m.instance, m.bough, m.z)
                                                           : seen.reflected / (1.0f - seen.through));
    seen.through = left;
    if (left < kHidden) break;
  }
  return seen;
}

double BoughScene::transmittance(const Vec3& origin_m, const Vec3& direction, double far_m) const {
  BoughContext c = state_->context();
  return std::exp(-state_->depth(origin_m - state_->centre_m, direction, far_m, c));
}

std::size_t BoughScene::boughs() const {
  std::size_t count = 0;
  for (const Placed& p : state_->placed) count += p.tree->rows.size();
  return count;
}

std::size_t BoughScene::memory_bytes() const {
  std::size_t bytes = state_->device.bytes() + state_->placed.size() * sizeof(Placed);
  for (const BoughTree& t : state_->trees) bytes += t.rows.size() * sizeof(BoughRow);
  for (const BoughTable& t : state_->tables) bytes += t.memory_bytes();
  return bytes;
}

}  // namespace sunfleck
