// The forest as a picture shows it: leaves with outlines in place of the flat elements, and rays that pass
// through what is cut away.
//
// A leaf that is shown with an outline is a rectangle around its axis (half_u along the leaf, half_v across),
// of the size at which the covered share of it has the element's area; its base stays where it was. A
// parallelogram's axis is its diagonal half_u + half_v (leaves of grammars are rhombi with their tip there);
// one that is as wide as long, and a disc, gets the outline's own aspect. Triangles and shoots stay.
//
// Two forests, one numbering of instances: the forest given, for which light was computed, and the forest
// shown, whose prototypes may have other leaves (outlines, or at lower levels of detail fewer and larger
// ones) in another order. Hits and RayStarts carry elements and segments of the forest SHOWN (`local` counts
// in shown_prototype(hit)); what is stored per element of the forest given is found by original_element, what
// is stored per prototype (optics, looks) by original_prototype. With levels of detail there are several
// casts of shown trees for the samples to choose from (picture_detail.h); forest() shows cast 0, which is
// also what a hit means that was not made by a ray.
#pragma once

#include <optional>
#include <vector>

#include "lighting/render/material_look.h"
#include "lighting/render/shown_trees.h"
#include "lighting/trace/ray_scene.h"

namespace sunfleck {

class PictureScene {
 public:
  // `forest` must outlive it. Throws Error(kInvalidInput) naming instances whose place is not finite, and
  // what MaterialLook throws. `details` as choose_details makes them for this forest.
  PictureScene(const Forest& forest, const PictureLook& look, const RunControl& control,
               const TreeDetails& details = {});
  PictureScene(const PictureScene&) = delete;
  PictureScene& operator=(const PictureScene&) = delete;

  RayHit closest_hit(const Vec3& origin_m, const Vec3& direction, const RayStart& from = {}) const;
  bool occluded(const Vec3& origin_m, const Vec3& direction, const RayStart& from = {}) const;

  // The forest shown. Its instances stand where those of the forest given do; their prototype ids are its
  // own.
  const Forest& forest() const { return shown_ ? shown_->forest : forest_; }
  const Forest& original_forest() const { return forest_; }
  // A ray of cast c (RayStart) meets the trees of that cast.
  std::size_t casts() const { return shown_ && !shown_->casts.empty() ? shown_->casts.size() : 1; }
  PrototypeId shown_id(const RayHit& hit) const {
    return casts() > 1 ? shown_->casts[hit.cast][hit.instance] : forest().instances[hit.instance].prototype;
  }
  const Prototype& shown_prototype(const RayHit& hit) const {
    return forest().prototypes[shown_id(hit).value];
  }
  PrototypeId original_prototype(std::uint32_t instance) const {
    return forest_.instances[instance].prototype;
  }
  // The foliage element of the forest given that a shown one stands for: an index into the foliage of
  // original_prototype(instance).
  std::uint32_t original_element(const RayHit& hit) const {
    return original_element(shown_id(hit), hit.local);
  }
  std::uint32_t original_element(std::uint32_t instance, std::uint32_t shown_local) const {  // of cast 0
    return original_element(forest().instances[instance].prototype, shown_local);
  }
  // At which level a tree is shown in cast 0.
  Detail detail_of(std::uint32_t instance) const {
    return shown_ ? shown_->detail[forest().instances[instance].prototype.value] : Detail::kExplicit;
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
  // Whether leaves of a shown prototype get the outline of their material.
  bool takes_outline(PrototypeId shown, const FoliageElement& element) const;
  std::uint32_t original_element(PrototypeId shown, std::uint32_t local) const {
    if (!shown_ || shown_->originals[shown.value].empty()) return local;
    return shown_->originals[shown.value][local];
  }
  const FoliageElement& element_of(const RayHit& hit) const;

  const Forest& forest_;
  std::optional<ShownTrees> shown_;  // where they differ
  std::vector<MaterialLook> looks_;
  std::vector<std::size_t> look_of_, first_;  // per original prototype's material; first of each prototype
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
