// The forest as a picture shows it: leaves with outlines in place of the flat elements, and rays that pass
// through what is cut away.
//
// A leaf that is shown with an outline is a rectangle around its axis (half_u along the leaf, half_v across),
// of the size at which the covered share of it has the element's area; its base stays where it was. A
// parallelogram's axis is its diagonal half_u + half_v (leaves of grammars are rhombi with their tip there);
// one that is as wide as long, and a disc, gets the outline's own aspect. Triangles and shoots stay.
//
// Two forests, one numbering of instances: the forest given, for which light was computed, and the forest
// shown, whose prototypes may have other leaves (outlines, fewer and larger ones) in another order. Hits and
// RayStarts carry elements, segments and prototypes of the forest SHOWN (`local` counts in
// shown_prototype(instance)); what is stored per element of the forest given is found by original_element,
// what is stored per prototype (optics, looks) by original_prototype.
#pragma once

#include <optional>
#include <vector>

#include "lighting/render/material_look.h"
#include "lighting/trace/ray_scene.h"

namespace sunfleck {

class PictureScene {
 public:
  // `forest` must outlive it. Throws Error(kInvalidInput) naming instances whose place is not finite, and
  // what MaterialLook throws.
  PictureScene(const Forest& forest, const PictureLook& look, const RunControl& control);
  PictureScene(const PictureScene&) = delete;
  PictureScene& operator=(const PictureScene&) = delete;

  RayHit closest_hit(const Vec3& origin_m, const Vec3& direction, const RayStart& from = {}) const;
  bool occluded(const Vec3& origin_m, const Vec3& direction, const RayStart& from = {}) const;

  // The forest shown. Its instances stand where those of the forest given do; their prototype ids are its
  // own.
  const Forest& forest() const { return shown_ ? *shown_ : forest_; }
  const Forest& original_forest() const { return forest_; }
  const Prototype& shown_prototype(std::uint32_t instance) const {
    return forest().prototypes[forest().instances[instance].prototype.value];
  }
  PrototypeId original_prototype(std::uint32_t instance) const {
    return forest_.instances[instance].prototype;
  }
  // The foliage element of the forest given that a shown one stands for: an index into the foliage of
  // original_prototype(instance).
  std::uint32_t original_element(std::uint32_t instance, std::uint32_t shown_local) const {
    const std::vector<std::uint32_t>& of = originals_[forest().instances[instance].prototype.value];
    return of.empty() ? shown_local : of[shown_local];
  }
  // Of an original prototype.
  const MaterialLook& look_of(PrototypeId prototype, std::size_t material) const {
    return looks_[look_of_[first_[prototype.value] + material]];
  }
  // Whether a point of the ground lies below the forest's box (always where it repeats).
  bool is_under_trees(const Vec3& point_m) const;
  const Box& box() const { return box_; }
  // Where on its leaf a foliage hit lies, for elements that have_outline; (0, 0) for others.
  Vec2 leaf_place(const RayHit& hit) const;
  bool has_outline(const RayHit& hit) const;
  // Unit vectors along and across the leaf, in the world.
  Basis leaf_axes(const RayHit& hit) const;
  // Metres around and along the wood segment hit.
  Vec2 bark_place(const RayHit& hit) const;

 private:
  void load_looks(const PictureLook& look);
  void reshape_leaves();
  bool is_hole(const RayHit& hit) const;
  const FoliageElement& element_of(const RayHit& hit) const;

  const Forest& forest_;
  std::optional<Forest> shown_;  // where it differs
  std::vector<MaterialLook> looks_;
  std::vector<std::size_t> look_of_, first_;  // per original prototype's material; first of each prototype
  std::vector<std::vector<std::uint32_t>> originals_;  // per shown prototype; empty: the same elements
  bool any_outline_ = false;
  Box box_;
  std::optional<RayScene> rays_;
};

// The names of all wood, foliage apart, that holds a point: for cameras that cannot see.
struct Inside {
  bool wood = false, below_ground = false;
  std::size_t instance = 0;
};
Inside what_holds(const Forest& forest, const Vec3& point_m);

}  // namespace sunfleck
