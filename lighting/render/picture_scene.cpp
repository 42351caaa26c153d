#include "lighting/render/picture_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <map>

#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

// Holes passed in a row before a leaf counts as solid: only leaves that lie in each other get there.
constexpr int kMostHoles = 256;
constexpr double kSquare = 1.05;  // wider against longer than this shows an aspect of its own

void check_places(const Forest& forest) {
  for (std::size_t i = 0; i < forest.instances.size(); ++i) {
    const Instance& at = forest.instances[i];
    if (!is_finite(at.position_m) || !std::isfinite(at.yaw_rad) || !(at.scale > 0.0f && at.scale <= 1e6f))
      throw_invalid("forest.instances[" + std::to_string(i) + "]",
                    "has a position, turn or scale that is not a finite number above its bounds",
                    "finite places and scales in (0, 1e6]");
    if (at.prototype.value >= forest.prototypes.size())
      throw_invalid("forest.instances[" + std::to_string(i) + "]",
                    "is of prototype " + std::to_string(at.prototype.value),
                    "one of the forest's " + std::to_string(forest.prototypes.size()));
  }
}

bool can_take_outline(ElementShape shape) {
  return shape == ElementShape::kParallelogram || shape == ElementShape::kDisc;
}

const MaterialTextures* textures_of(const PictureLook& look, const std::string& material) {
  const MaterialTextures* found = nullptr;
  for (const MaterialTextures& t : look.textures)
    if (t.material == material || (t.material == "*" && found == nullptr)) found = &t;
  return found;
}

// The rectangle that shows a leaf.
FoliageElement with_outline(FoliageElement e, const MaterialLook& look) {
  const bool disc = e.shape == ElementShape::kDisc;
  const Vec3 u(e.half_u_m), v(e.half_v_m);
  Vec3 along = disc ? u : u + v, across = disc ? v : v - u;
  // A skew parallelogram: the part of its other diagonal that is across the axis; areas stay.
  const double length2 = glm::dot(along, along);
  if (!(length2 > 0.0)) return e;
  across -= glm::dot(across, along) / length2 * along;
  const double aspect = std::sqrt(length2) / std::max(glm::length(across), 1e-30);
  if (aspect < kSquare && aspect > 1.0 / kSquare) {
    const double stretch = std::sqrt(look.aspect() / aspect);
    along *= stretch, across /= stretch;
  }
  const double box_m2 = 4.0 * glm::length(glm::cross(along, across));
  if (!(box_m2 > 0.0)) return e;
  const double grow = std::sqrt(e.area_m2 / (look.covered_share() * box_m2));
  const Vec3 base = disc ? Vec3(e.centre_m) - along : Vec3(e.centre_m) - (u + v);
  e.half_u_m = Vec3f(grow * along);
  e.half_v_m = Vec3f(grow * across);
  e.centre_m = Vec3f(disc ? Vec3(e.centre_m) : base + grow * along);
  e.area_m2 = static_cast<float>(grow * grow * box_m2);
  e.shape = ElementShape::kParallelogram;
  return e;
}

bool holds(const WoodSegment& s, const Vec3& p) {
  const Vec3 from(s.from_m), axis = Vec3(s.to_m) - from;
  const double length2 = glm::dot(axis, axis);
  if (!(length2 > 0.0)) return false;
  const double t = glm::dot(p - from, axis) / length2;
  if (t < 0.0 || t > 1.0) return false;
  const double radius =
      std::lerp(static_cast<double>(s.radius_from_m), static_cast<double>(s.radius_to_m), t);
  return glm::length(p - from - t * axis) < radius;
}

Vec3 base_cell_point(const Forest& forest, Vec3 p) {
  if (!forest.period) return p;
  const Period& period = *forest.period;
  const double height = p.z - forest.terrain.height_at(p.x, p.y);
  for (int a = 0; a < 2; ++a)
    p[a] -= std::floor((p[a] - period.origin_m[a]) / period.size_m[a]) * period.size_m[a];
  p.z = forest.terrain.height_at(p.x, p.y) + height;
  return p;
}

}  // namespace

PictureScene::PictureScene(const Forest& forest, const PictureLook& look, const RunControl& control,
                           const TreeDetails& details)
    : forest_(forest) {
  check_places(forest);
  load_looks(look);
  if (!details.casts.empty()) shown_ = show_trees(forest, details, control);
  reshape_leaves();
  box_ = forest_bounds(forest_);
  RayScene::Options options{.shoots = look.shoots, .needles = look.needles, .coordinates = box_};
  if (shown_) options.casts = shown_->casts;
  rays_.emplace(this->forest(), options, control);
}

void PictureScene::load_looks(const PictureLook& look) {
  std::map<std::string, std::size_t> known;
  for (const Prototype& prototype : forest_.prototypes) {
    first_.push_back(look_of_.size());
    for (const std::string& material : prototype.materials) {
      const auto [at, added] = known.try_emplace(material, looks_.size());
      if (added) looks_.emplace_back(look, material, textures_of(look, material));
      look_of_.push_back(at->second);
    }
  }
}

bool PictureScene::takes_outline(PrototypeId shown, const FoliageElement& e) const {
  if (shown_ && shown_->detail[shown.value] != Detail::kExplicit) return false;
  const PrototypeId original = shown_ ? shown_->original_prototype[shown.value] : shown;
  return can_take_outline(e.shape) && look_of(original, e.material).changes_outline();
}

void PictureScene::reshape_leaves() {
  const std::vector<Prototype>& prototypes = forest().prototypes;
  for (std::uint32_t p = 0; p < prototypes.size() && !any_outline_; ++p)
    any_outline_ = std::any_of(prototypes[p].foliage.begin(), prototypes[p].foliage.end(),
                               [&](const FoliageElement& e) { return takes_outline(PrototypeId{p}, e); });
  if (!any_outline_) return;
  if (!shown_) shown_ = same_trees(forest_);
  for (std::uint32_t p = 0; p < shown_->forest.prototypes.size(); ++p)
    for (FoliageElement& e : shown_->forest.prototypes[p].foliage)
      if (takes_outline(PrototypeId{p}, e))
        e = with_outline(e, look_of(shown_->original_prototype[p], e.material));
}

bool PictureScene::is_under_trees(const Vec3& p) const {
  return forest_.period || (p.x >= box_.lo.x && p.x <= box_.hi.x && p.y >= box_.lo.y && p.y <= box_.hi.y);
}

const FoliageElement& PictureScene::element_of(const RayHit& hit) const {
  return shown_prototype(hit).foliage[hit.local];
}

bool PictureScene::has_outline(const RayHit& hit) const {
  if (!any_outline_ || hit.kind != HitKind::kFoliage) return false;
  const FoliageElement& e = element_of(hit);
  return e.shape == ElementShape::kParallelogram && takes_outline(shown_id(hit), e);
}

Vec2 PictureScene::leaf_place(const RayHit& hit) const {
  const FoliageElement& e = element_of(hit);
  if (e.shape != ElementShape::kParallelogram) return Vec2(0.0);
  const Vec3 u(e.half_u_m), v(e.half_v_m);
  const Vec3 from_centre =
      tree_from_world(forest_.instances[hit.instance], hit.on_original_m) - Vec3(e.centre_m);
  return {glm::dot(from_centre, u) / glm::dot(u, u), glm::dot(from_centre, v) / glm::dot(v, v)};
}

Basis PictureScene::leaf_axes(const RayHit& hit) const {
  const FoliageElement& e = element_of(hit);
  const Instance& at = forest_.instances[hit.instance];
  return {glm::normalize(world_direction_from_tree(at, Vec3(e.half_u_m))),
          glm::normalize(world_direction_from_tree(at, Vec3(e.half_v_m)))};
}

Vec2 PictureScene::bark_place(const RayHit& hit) const {
  const Instance& at = forest_.instances[hit.instance];
  const Vec3 p = tree_from_world(at, hit.on_original_m);
  if (hit.kind == HitKind::kWoodMesh) return static_cast<double>(at.scale) * Vec2(p.x + p.y, p.z);
  const WoodSegment& s = shown_prototype(hit).wood[hit.local];
  const Vec3 axis = Vec3(s.to_m) - Vec3(s.from_m);
  const double length = glm::length(axis);
  if (!(length > 0.0)) return Vec2(0.0);
  // Turns are counted in the tree's frame, radii of the lower end, so that segments of a stem join.
  const Vec3 out = p - Vec3(s.from_m);
  const double turn_rad = std::atan2(out.y, out.x);
  return static_cast<double>(at.scale) *
         Vec2(turn_rad * std::max(0.02, static_cast<double>(s.radius_from_m)), p.z);
}

bool PictureScene::is_hole(const RayHit& hit) const {
  if (!has_outline(hit)) return false;
  const FoliageElement& e = element_of(hit);
  return !look_of(original_prototype(hit.instance), e.material).is_inside(leaf_place(hit));
}

RayHit PictureScene::closest_hit(const Vec3& origin_m, const Vec3& direction, const RayStart& from) const {
  RayHit hit = rays_->closest_hit(origin_m, direction, 0.0, from);
  double before_m = 0.0;
  for (int holes = 0; holes < kMostHoles && is_hole(hit); ++holes) {
    before_m += hit.distance_m;
    hit = rays_->closest_hit(hit.on_original_m, direction, 0.0, start_from(hit, false));
  }
  hit.distance_m += before_m;
  return hit;
}

bool PictureScene::occluded(const Vec3& origin_m, const Vec3& direction, const RayStart& from) const {
  if (!any_outline_) return rays_->occluded(origin_m, direction, 0.0, from);
  return closest_hit(origin_m, direction, from).kind != HitKind::kSky;
}

Inside what_holds(const Forest& forest, const Vec3& point_m) {
  Inside inside;
  inside.below_ground = point_m.z < forest.terrain.height_at(point_m.x, point_m.y) - 1e-6;
  const Vec3 p = base_cell_point(forest, point_m);
  std::vector<Box> boxes;
  for (const Prototype& prototype : forest.prototypes) {
    Box box;
    for (const WoodSegment& s : prototype.wood)
      for (const auto& [end, radius] : {std::pair{s.from_m, s.radius_from_m}, {s.to_m, s.radius_to_m}}) {
        box.include(Vec3(end) - static_cast<double>(radius));
        box.include(Vec3(end) + static_cast<double>(radius));
      }
    boxes.push_back(box);
  }
  for (std::size_t i = 0; i < forest.instances.size() && !inside.wood; ++i) {
    const Instance& at = forest.instances[i];
    const Box& box = boxes[at.prototype.value];
    const Vec3 local = tree_from_world(at, p);
    if (box.empty() || glm::any(glm::lessThan(local, box.lo)) || glm::any(glm::greaterThan(local, box.hi)))
      continue;
    const auto& wood = forest.prototypes[at.prototype.value].wood;
    inside.wood =
        std::any_of(wood.begin(), wood.end(), [&](const WoodSegment& s) { return holds(s, local); });
    inside.instance = i;
  }
  return inside;
}

}  // namespace sunfleck
