#include "lighting/trace/raster_project.h"

#include "lighting/trace/solids.h"

namespace sunfleck::trace {
namespace {

std::int32_t floor_div(std::int32_t a, std::int32_t b) { return a / b - (a % b < 0 ? 1 : 0); }

struct Wraps {
  std::int32_t first_u = 0, last_u = 0, first_v = 0, last_v = 0;
};
Wraps wraps_of(const RasterView& view, const PixelBox& b) {
  if (!view.wraps) return {};
  return {floor_div(b.u_lo, view.u_count), floor_div(b.u_hi - 1, view.u_count), floor_div(b.v_lo, view.v_count),
          floor_div(b.v_hi - 1, view.v_count)};
}

PixelBox moved(const PixelBox& b, std::int32_t u, std::int32_t v) {
  return {b.u_lo + u, b.v_lo + v, b.u_hi + u, b.v_hi + v};
}

// Every pixel whose square lies within reach of a point, kept inside what integers hold.
PixelBox box_around(double u, double v, double reach_u, double reach_v) {
  const auto low = [](double x) { return static_cast<std::int32_t>(std::clamp(std::floor(x), -1e9, 1e9)); };
  return {low(u - reach_u), low(v - reach_v), low(u + reach_u) + 1, low(v + reach_v) + 1};
}

class Projector {
 public:
  Projector(const RasterView& view, const PlacedTree& tree, const PixelBox& part, RasterScene& out)
      : view_(view), tree_(tree), part_(part), out_(out) {}

  void flat(const FoliageElement& e, Figure figure, std::uint32_t element) {
    flat(Vec3(e.centre_m), Vec3(e.half_u_m), Vec3(e.half_v_m), figure, element);
  }

  void flat(const Vec3& centre, const Vec3& half_u, const Vec3& half_v, Figure figure, std::uint32_t element) {
    RasterRecord r;
    take_centre(r, centre, figure, element);
    const double au = glm::dot(tree_.u_per_m, half_u), av = glm::dot(tree_.v_per_m, half_u);
    const double bu = glm::dot(tree_.u_per_m, half_v), bv = glm::dot(tree_.v_per_m, half_v);
    const bool disc = figure == Figure::kDisc;
    const double reach_u = disc ? std::hypot(au, bu) : std::abs(au) + std::abs(bu);
    const double reach_v = disc ? std::hypot(av, bv) : std::abs(av) + std::abs(bv);
    r.bounds = box_around(r.u, r.v, reach_u, reach_v);
    const double det = au * bv - av * bu, longest2 = std::max(au * au + av * av, bu * bu + bv * bv);
    // Narrower than a pixel's diagonal somewhere, its rows and columns may pass between all centres.
    r.small = !(std::abs(det) > 1.5 * std::sqrt(longest2));
    r.a_du = static_cast<float>(au), r.a_dv = static_cast<float>(av);
    r.b_du = static_cast<float>(bu), r.b_dv = static_cast<float>(bv);
    r.s_a = static_cast<float>(glm::dot(tree_.s_per_m, half_u));
    r.s_b = static_cast<float>(glm::dot(tree_.s_per_m, half_v));
    emit(r);
  }

  // `solid` with lowest, highest, radius, taper, widest; axis as a unit vector of the world.
  void solid(RasterSolid solid, const Vec3& centre, const Vec3& axis, Figure figure, std::uint32_t element) {
    RasterRecord r;
    take_centre(r, centre, figure, element);
    solid.height_u = glm::dot(view_.u_step_m, axis);
    solid.height_v = glm::dot(view_.v_step_m, axis);
    solid.rise = glm::dot(view_.to_sun, axis);
    const Vec3 across_u = view_.u_step_m - solid.height_u * axis, across_v = view_.v_step_m - solid.height_v * axis;
    const Vec3 run = view_.to_sun - solid.rise * axis;
    solid.across_uu = glm::dot(across_u, across_u);
    solid.across_uv = glm::dot(across_u, across_v);
    solid.across_vv = glm::dot(across_v, across_v);
    solid.run_u = glm::dot(across_u, run);
    solid.run_v = glm::dot(across_v, run);
    solid.run2 = glm::dot(run, run);
    const Vec3 aside = glm::cross(axis, view_.to_sun);
    const double length = glm::length(aside);
    solid.aside_u = length > 1e-9 ? glm::dot(view_.u_step_m, aside) / length : 0.0;
    solid.aside_v = length > 1e-9 ? glm::dot(view_.v_step_m, aside) / length : 0.0;
    r.bounds = bounds_of(solid, r, axis);
    r.small = is_small(solid, r.bounds);
    r.solid = static_cast<std::uint32_t>(out_.solids.size());
    const std::size_t before = out_.records.size();
    emit(r);
    if (out_.records.size() > before) out_.solids.push_back(solid);
  }

 private:
  void take_centre(RasterRecord& r, const Vec3& centre, Figure figure, std::uint32_t element) const {
    r.u = tree_.u + glm::dot(tree_.u_per_m, centre);
    r.v = tree_.v + glm::dot(tree_.v_per_m, centre);
    r.s = static_cast<float>(tree_.s + glm::dot(tree_.s_per_m, centre));
    r.figure = figure;
    r.element = element;
  }

  static bool is_small(const RasterSolid& solid, const PixelBox& b) {
    const double pixel_aside = std::hypot(solid.aside_u, solid.aside_v);
    return 2.0 * solid.widest < 2.0 * pixel_aside || b.u_hi - b.u_lo < 4 || b.v_hi - b.v_lo < 4;
  }

  // Of the rims at both ends.
  PixelBox bounds_of(const RasterSolid& solid, const RasterRecord& r, const Vec3& axis) const {
    const auto interval = [&](const Vec3& per_m, double centre, double& lo, double& hi) {
      const double along = glm::dot(per_m, axis), rim = glm::length(per_m - along * axis);
      lo = std::numeric_limits<double>::infinity(), hi = -lo;
      for (const double h : {solid.lowest, solid.highest}) {
        const double reach = std::max(0.0, solid.radius + solid.taper * h) * rim;
        lo = std::min(lo, centre + h * along - reach);
        hi = std::max(hi, centre + h * along + reach);
      }
    };
    double u_lo, u_hi, v_lo, v_hi;
    interval(view_.u_per_m, r.u, u_lo, u_hi);
    interval(view_.v_per_m, r.v, v_lo, v_hi);
    return box_around(0.5 * (u_lo + u_hi), 0.5 * (v_lo + v_hi), 0.5 * (u_hi - u_lo), 0.5 * (v_hi - v_lo));
  }

  // One record per wrapped copy that touches the part.
  void emit(const RasterRecord& r) {
    const Wraps w = wraps_of(view_, r.bounds);
    for (std::int32_t i = w.first_u; i <= w.last_u; ++i)
      for (std::int32_t j = w.first_v; j <= w.last_v; ++j) {
        const std::int32_t du = -i * view_.u_count, dv = -j * view_.v_count;
        const PixelBox bounds = moved(r.bounds, du, dv);
        if (common(bounds, part_).empty()) continue;
        out_.records.push_back(r);
        out_.records.back().u += du;
        out_.records.back().v += dv;
        out_.records.back().bounds = bounds;
      }
  }

  const RasterView& view_;
  const PlacedTree& tree_;
  const PixelBox& part_;
  RasterScene& out_;
};

Vec3 point_of(const Instance& instance, const Vec3f& p) { return world_from_tree(instance, Vec3(p)); }

void project_shoot(Projector& projector, const Instance& instance, const FoliageElement& e,
                   std::uint32_t element) {
  const double scale = instance.scale, length = glm::length(Vec3(e.half_u_m)), radius = glm::length(Vec3(e.half_v_m));
  const double volume_m3 = 2.0 * length * kPi * radius * radius;
  RasterSolid solid;
  solid.highest = scale * length;
  solid.lowest = -solid.highest;
  solid.radius = solid.widest = scale * radius;
  // Half the one-sided needle area per volume, as in RayScene.
  solid.extinction_per_m = volume_m3 > 0.0 ? static_cast<float>(0.5 * e.area_m2 / volume_m3 / scale) : 0.0f;
  const Vec3 axis = length > 0.0 ? Vec3(e.half_u_m) / length : Vec3(0, 0, 1);
  projector.solid(solid, Vec3(e.centre_m), world_direction_from_tree(instance, axis), Figure::kShoot, element);
}

void project_segment(Projector& projector, const Instance& instance, const WoodSegment& s) {
  const double scale = instance.scale;
  const ConeFrustum cone = cone_between(point_of(instance, s.from_m), point_of(instance, s.to_m),
                                        scale * s.radius_from_m, scale * s.radius_to_m);
  if (!(cone.length > 0.0)) return;
  RasterSolid solid;
  solid.highest = cone.length;
  solid.radius = cone.radius_at_base;
  solid.taper = cone.taper;
  solid.widest = scale * std::max(s.radius_from_m, s.radius_to_m);
  projector.solid(solid, Vec3(s.from_m), cone.axis, Figure::kCone, kOnlyShades);
}

}  // namespace

PlacedTree place_tree(const RasterView& view, const Forest& forest, std::size_t number, const Box& box) {
  const Instance& instance = forest.instances[number];
  const double scale = instance.scale;
  const Vec3 at = instance.position_m - view.centre_m;
  PlacedTree tree;
  tree.instance = static_cast<std::uint32_t>(number);
  tree.u_per_m = scale * tree_direction_from_world(instance, view.u_per_m);
  tree.v_per_m = scale * tree_direction_from_world(instance, view.v_per_m);
  tree.s_per_m = scale * tree_direction_from_world(instance, view.s_per_m);
  tree.u = glm::dot(view.u_per_m, at) + view.u_shift;
  tree.v = glm::dot(view.v_per_m, at) + view.v_shift;
  tree.s = glm::dot(view.s_per_m, at);
  if (box.empty()) return tree;
  const Vec3 half = 0.5 * box.size();
  tree.bounds = box_around(tree.u + glm::dot(tree.u_per_m, box.centre()),
                           tree.v + glm::dot(tree.v_per_m, box.centre()),
                           glm::dot(glm::abs(tree.u_per_m), half) + 1e-3,
                           glm::dot(glm::abs(tree.v_per_m), half) + 1e-3);
  return tree;
}

bool touches(const RasterView& view, const PixelBox& bounds, const PixelBox& part) {
  if (bounds.empty()) return false;
  const Wraps w = wraps_of(view, bounds);
  for (std::int32_t i = w.first_u; i <= w.last_u; ++i)
    for (std::int32_t j = w.first_v; j <= w.last_v; ++j)
      if (!common(moved(bounds, -i * view.u_count, -j * view.v_count), part).empty()) return true;
  return false;
}

void project_foliage(const RasterView& view, const Forest& forest, const PlacedTree& tree,
                     std::size_t first_element, std::size_t first, std::size_t end, const PixelBox& part,
                     RasterScene& out) {
  Projector projector(view, tree, part, out);
  const Instance& instance = forest.instances[tree.instance];
  const auto& foliage = forest.prototypes[instance.prototype.value].foliage;
  for (std::size_t i = first; i < end; ++i) {
    const auto element = static_cast<std::uint32_t>(first_element + i);
    switch (foliage[i].shape) {
      case ElementShape::kParallelogram:
        projector.flat(foliage[i], Figure::kParallelogram, element);
        break;
      case ElementShape::kDisc:
        projector.flat(foliage[i], Figure::kDisc, element);
        break;
      case ElementShape::kTriangle:
        projector.flat(foliage[i], Figure::kTriangle, element);
        break;
      case ElementShape::kShoot:
        project_shoot(projector, instance, foliage[i], element);
    }
  }
}

void project_wood(const RasterView& view, const Forest& forest, const PlacedTree& tree, const PixelBox& part,
                  RasterScene& out) {
  Projector projector(view, tree, part, out);
  const Instance& instance = forest.instances[tree.instance];
  const Prototype& prototype = forest.prototypes[instance.prototype.value];
  for (const WoodSegment& s : prototype.wood) project_segment(projector, instance, s);
  for (const WoodTriangle& t : prototype.wood_mesh)
    projector.flat(Vec3(t.a_m + t.b_m + t.c_m) / 3.0, Vec3(t.b_m - t.a_m), Vec3(t.c_m - t.a_m), Figure::kTriangle,
                   kOnlyShades);
}

}  // namespace sunfleck::trace
