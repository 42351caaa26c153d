#include "lighting/render/seen_trees.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>

#include "lighting/render/camera_rays.h"
#include "lighting/render/material_look.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr double kGatherHeights = 3.0, kNearHeights = 2.0, kLeastReachM = 50.0;
constexpr double kRoundingShare = 1e-5;  // of coordinates: more than those of rays are off

Vec3 farthest_along(const Box& box, const Vec3& normal) {
  return {normal.x > 0 ? box.hi.x : box.lo.x, normal.y > 0 ? box.hi.y : box.lo.y,
          normal.z > 0 ? box.hi.z : box.lo.z};
}

Box grown(Box box, double by_m) {
  box.lo -= by_m;
  box.hi += by_m;
  return box;
}

Box moved(Box box, const Vec3& by_m) {
  box.lo += by_m;
  box.hi += by_m;
  return box;
}

double distance_m(const Vec3& p, const Box& box) {
  return glm::length(glm::max(glm::max(box.lo - p, p - box.hi), Vec3(0.0)));
}

bool overlap(const Box& a, const Box& b) {
  return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y && a.lo.z <= b.hi.z &&
         b.lo.z <= a.hi.z;
}

Box bounds_of(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& box : boxes)
    if (!box.empty()) all.include(box);
  return all;
}

// How far along the view's axis a box begins for parallel rays, else how far from the camera it is.
double depth_m(const Camera& camera, const Box& box) {
  if (camera.kind != CameraKind::kOrthographic) return distance_m(camera.position_m, box);
  const Vec3 forward = glm::normalize(camera.look_at_m - camera.position_m);
  return std::max(0.0, glm::dot(forward, farthest_along(box, -forward) - camera.position_m));
}

// Leaves shown with an outline may stick out of the flat elements: by at most their own diagonal, whose
// square is area / covered share * (aspect + 1 / aspect).
double outline_growth(const PictureLook& look, const std::vector<Material>& materials) {
  double most = 1.0;
  const auto take = [&](const MaterialLook& m) {
    const double aspect = std::max(m.aspect(), 1.0 / m.aspect());
    most = std::max(most, std::sqrt(2.0 * aspect / std::max(m.covered_share(), 1e-6)));
  };
  for (const Material& material : materials) {
    take(MaterialLook(look, material.name, nullptr));
    for (const MaterialTextures& t : look.textures) take(MaterialLook(look, material.name, &t));
  }
  return most;
}

struct Selector {
  const ForestOutline& forest;
  const RenderRequest& request;
  std::vector<Box> boxes, shown;  // of the instances as they are, and with leaves that stick out
  Box all;
  ViewVolume view;
  std::vector<char> needed;
  bool has_sun;

  Selector(const ForestOutline& f, const std::vector<Material>& materials, const RenderRequest& r)
      : forest(f), request(r), boxes(instance_boxes(f)), view(r.camera), needed(boxes.size(), 0) {
    all = bounds_of(boxes);
    const double growth = outline_growth(r.look, materials);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Instance& at = f.instances[i];
      const double leaf_m = f.prototypes[at.prototype.value].longest_leaf_m * static_cast<double>(at.scale);
      const double rounding_m = kRoundingShare * (glm::length(all.size()) + glm::length(boxes[i].hi));
      shown.push_back(boxes[i].empty() ? boxes[i] : grown(boxes[i], growth * leaf_m + rounding_m));
    }
    has_sun = r.light.sun_is_up() && std::any_of(r.light.bands.begin(), r.light.bands.end(),
                                                 [](const BandLight& b) { return b.beam_normal_w_m2 > 0; });
  }

  // Box and its shadow on the ground, wider by the sun's disc; the box twice where there is no sun.
  std::array<Box, 2> with_shadow(const Box& box) const {
    if (!has_sun) return {box, box};
    const Vec3 normal = forest.terrain.normal();
    const double towards = glm::dot(request.light.to_sun, normal);
    const Vec3 top = farthest_along(box, normal);
    const double height_m = normal.z * (top.z - forest.terrain.height_at(top.x, top.y)) +
                            kRoundingShare * glm::length(all.size());
    // A sun behind the slope, or at its edge, throws shadows through the whole forest.
    const double farthest_m = 2.0 * glm::length(all.size()) + glm::length(all.hi - request.camera.position_m);
    const double way_m = towards > 0 ? std::min(std::max(0.0, height_m) / towards, farthest_m) : farthest_m;
    const double wider_m = way_m * std::tan(std::min(request.light.sun_half_angle_rad, 1.5));
    return {box, grown(moved(box, -way_m * request.light.to_sun), wider_m)};
  }

  template <class Needs>
  void add(const Needs& needs) {
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (!needed[i] && !shown[i].empty() && needs(i)) needed[i] = 1;
  }

  void add_seen_and_shading(double margin_m) {
    add([&](std::size_t i) { return view.may_meet(with_shadow(shown[i]), margin_m); });
  }
  void add_within(double reach_m) {
    add([&](std::size_t i) { return view.may_meet(std::span(&shown[i], 1), reach_m); });
  }

  // What the rays of the mean light of wood and ground may meet: they start in the box of the near trees.
  void add_for_mean_light(double reach_m) {
    const NearTrees near = near_trees(request.camera, boxes, false);
    if (near.box.empty()) return;
    Box from = near.box;
    for (const double x : {near.box.lo.x, near.box.hi.x})
      for (const double y : {near.box.lo.y, near.box.hi.y})
        from.include({x, y, forest.terrain.height_at(x, y)});
    from = grown(from, kRoundingShare * glm::length(all.size()));
    add([&](std::size_t i) {
      if (near.is_near[i] || overlap(grown(from, reach_m), shown[i])) return true;
      const auto [box, shadow] = with_shadow(shown[i]);
      Box both = box;
      both.include(shadow);
      return overlap(both, from);
    });
  }

  // The trees that the forest's box ends at: it fixes the coordinates of rays and the ground below trees.
  void add_rim() {
    for (int axis = 0; axis < 3; ++axis)
      for (const bool upper : {false, true})
        for (std::size_t i = 0; i < boxes.size(); ++i)
          if (!boxes[i].empty() &&
              (upper ? boxes[i].hi[axis] == all.hi[axis] : boxes[i].lo[axis] == all.lo[axis])) {
            needed[i] = 1;
            break;
          }
  }
};

template <class... Parts>
std::string formatted(const char* format, Parts... parts) {
  char text[256];
  std::snprintf(text, sizeof text, format, parts...);
  return text;
}

TreeSelection counted(const ForestOutline& forest, const Selector& selector, TreeSelection selection) {
  selection.trees = selector.needed;
  selection.prototypes.assign(forest.prototypes.size(), 0);
  for (std::size_t i = 0; i < selection.trees.size(); ++i) {
    if (selector.view.may_meet(std::span(&selector.boxes[i], 1), 0.0)) ++selection.trees_seen;
    if (!selection.trees[i]) continue;
    ++selection.trees_needed;
    selection.prototypes[forest.instances[i].prototype.value] = 1;
  }
  selection.prototypes_needed =
      static_cast<std::size_t>(std::count(selection.prototypes.begin(), selection.prototypes.end(), char{1}));
  return selection;
}

TreeSelection keep_all(const ForestOutline& forest, Selector& selector, const char* reason) {
  std::fill(selector.needed.begin(), selector.needed.end(), char{1});
  TreeSelection selection;
  selection.reason = reason;
  return counted(forest, selector, selection);
}

}  // namespace

ViewVolume::ViewVolume(const Camera& camera) {
  const CameraRays rays(camera);
  const double width = camera.width_px, height = camera.height_px;
  const CameraRay middle = *rays.through(0.5 * width, 0.5 * height);
  const Vec3 forward = middle.direction;
  sides_.push_back({forward, glm::dot(forward, camera.position_m)});
  if (camera.kind == CameraKind::kFisheye) return;
  const std::array<CameraRay, 4> corners = {*rays.through(0, 0), *rays.through(width, 0),
                                            *rays.through(width, height), *rays.through(0, height)};
  const Vec3 inside = middle.origin_m + forward;
  for (std::size_t c = 0; c < 4; ++c) {
    const CameraRay &a = corners[c], &b = corners[(c + 1) % 4];
    const Vec3 across = camera.kind == CameraKind::kPinhole ? b.direction : b.origin_m - a.origin_m;
    Vec3 normal = glm::normalize(glm::cross(a.direction, across));
    if (glm::dot(normal, inside - a.origin_m) < 0.0) normal = -normal;
    sides_.push_back({normal, glm::dot(normal, a.origin_m)});
  }
}

bool ViewVolume::may_meet(std::span<const Box> boxes, double margin_m) const {
  return std::all_of(sides_.begin(), sides_.end(), [&](const HalfSpace& side) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
      return !box.empty() &&
             glm::dot(side.normal, farthest_along(box, side.normal)) >= side.offset - margin_m;
    });
  });
}

double gather_reach_m(const Box& forest) { return std::max(kLeastReachM, kGatherHeights * forest.size().z); }

NearTrees near_trees(const Camera& camera, const std::vector<Box>& boxes, bool periodic) {
  const ViewVolume view(camera);
  const Box all = bounds_of(boxes);
  std::vector<double> depths(boxes.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty() && (periodic || view.may_meet(std::span(&boxes[i], 1), 0.0)))
      depths[i] = periodic ? 0.0 : depth_m(camera, boxes[i]);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const double depth : depths) nearest_m = std::min(nearest_m, depth);
  NearTrees near{std::vector<char>(boxes.size(), 0), {}};
  if (!std::isfinite(nearest_m)) return near;
  const double within_m = nearest_m + std::max(kLeastReachM, kNearHeights * all.size().z);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (depths[i] > within_m) continue;
    near.is_near[i] = 1;
    near.box.include(boxes[i]);
  }
  return near;
}

TreeSelection trees_for_picture(const ForestOutline& forest, const std::vector<Material>& materials,
                                const RenderRequest& request, RenderMode mode, double far_light) {
  validate(request);
  if (!(far_light >= 0.0 && far_light <= 0.5))
    throw_invalid("far_light", "is " + std::to_string(far_light), "a share of light, 0 to 0.5");
  Selector selector(forest, materials, request);
  if (forest.period) return keep_all(forest, selector, "the forest repeats without end");
  if (request.detail.mode != DetailMode::kFull)
    return keep_all(forest, selector, "enlarged leaves of far trees may stick out of their boxes");
  if (mode == RenderMode::kPathTraced && far_light == 0.0)
    return keep_all(forest, selector, "paths come from everywhere");
  TreeSelection selection;
  if (mode == RenderMode::kLightMap) {
    const double reach_m = gather_reach_m(selector.all);
    selector.add_seen_and_shading(0.0);
    selector.add_within(reach_m);
    selector.add_for_mean_light(reach_m);
    selection.reason =
        formatted("with what shades them and what stands within %.0f m of wood and ground", reach_m);
  } else {
    const double reach_m = selector.all.size().z / std::tan(0.5 * kPi * far_light);
    selector.add_seen_and_shading(reach_m);
    selection.light_bound = far_light;
    selection.reason =
        formatted("with what stands within %.0f m of what is seen and what shades that", reach_m);
  }
  selector.add_rim();
  return counted(forest, selector, selection);
}

}  // namespace sunfleck
