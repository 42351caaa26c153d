// What one material's leaves and bark look like, ready to be asked at a place: images loaded, means known.
#pragma once

#include <optional>

#include "lighting/render/picture_look.h"
#include "lighting/render/texture_image.h"

namespace sunfleck {

class MaterialLook {
 public:
  // Loads the images of `textures`; throws as load_texture does, and where a leaf's alpha image is empty.
  MaterialLook(const PictureLook& look, const std::string& material, const MaterialTextures* textures);

  bool changes_outline() const { return alpha_ || outline_ != LeafOutline::kAsModelled; }
  double covered_share() const { return share_; }  // of the box of a leaf, when it changes outlines
  double aspect() const { return aspect_; }        // length over width for elements that show none
  bool is_inside(const Vec2& at) const;

  // Factors on a leaf's reflectance and transmittance; mean 1 over the leaf.
  Vec3 leaf_reflect(const Vec2& at) const;
  Vec3 leaf_pass(const Vec2& at) const;
  // How much of a leaf's pattern is left in the mean over a stretch of it, given in lengths of the leaf:
  // veins are gone from a seventh on, images from a half on.
  double leaf_pattern_left(double stretch) const;
  // Normal in leaf coordinates (along, across, front); unit.
  Vec3 leaf_normal(const Vec2& at) const;
  bool has_normals() const { return normal_.has_value(); }
  // Factor on bark at metres around and along the stem; mean 1. `footprint_m`: see litter_pattern.
  Vec3 bark(const Vec2& at_m, double footprint_m = 0.0) const;

 private:
  void take_means();
  Vec3 raw_reflect(const Vec2& at) const;
  double raw_pass(const Vec2& at) const;

  LeafOutline outline_;
  bool patterns_;
  double bark_width_m_;
  std::optional<TextureImage> alpha_, reflectance_, thickness_, normal_, bark_;
  double share_ = 1, aspect_ = 1.5;
  Vec3 mean_reflect_{1}, mean_bark_{1};
  double mean_pass_ = 1;
};

// Variation of the ground, mean 1 over large areas: patches of metres, litter of centimetres. The mean over a
// square of side `footprint_m` is guessed from its middle: variation of size s keeps 1 / (1 + (side / s)^2).
Vec3 litter_pattern(const Vec2& at_m, double footprint_m = 0.0);

// Smooth noise of mean 0 and values in (-1, 1): random numbers on a lattice of spacing 1, between them cubic.
double lattice_noise(const Vec2& at, std::uint64_t seed);

}  // namespace sunfleck
