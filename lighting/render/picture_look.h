// How surfaces look in a picture beyond the numbers that light was computed with: outlines of leaves, images
// on leaves and bark, patterns. [Boulanger08] 3.3: a leaf's light is one number per face; variation along the
// leaf comes from a texture that modulates the reflectance, a thickness map that modulates the transmitted
// light, and a normal map for a specular part.
//
// Everything keeps what the light was computed from: leaves keep their area (an outline or alpha image that
// covers a share s of its box is enlarged by 1 / sqrt(s)), images and patterns modulate around a mean of 1
// over the leaf, the specular part is taken out of the diffuse one. Light maps stay as they are.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lighting/render/leaf_outline.h"
#include "lighting/render/texture_image.h"
#include "lighting/trace/ray_scene.h"

namespace sunfleck {

// Images for one material. Empty paths: none. Leaf images stand upright: base at the bottom, tip at the top,
// front face seen. Bark images repeat; their upper edge points along the stem.
struct MaterialTextures {
  std::string material = "*";        // latin name of the species; "*": all that have no entry of their own
  std::filesystem::path leaf_alpha;  // opaque where its alpha (or grey) is at least 0.5; replaces the outline
  std::filesystem::path leaf_reflectance;  // colour, relative
  std::filesystem::path leaf_thickness;    // grey: light falls off with it, transmittance ~ exp(-2 thickness)
  std::filesystem::path leaf_normal;       // tangent space, 0.5 0.5 1 flat
  std::filesystem::path bark;              // colour, relative
  std::string where;                       // of this entry in its file, for messages
  // Pixels in place of files, by the names above ("leaf_alpha", "bark"): of a request from elsewhere.
  std::map<std::string, std::shared_ptr<const TexturePixels>> given;
};

struct TextureSlot {
  const char* name;
  TextureKind kind;
  std::filesystem::path MaterialTextures::*file;
};
inline constexpr std::array<TextureSlot, 5> kTextureSlots = {
    {{"leaf_alpha", TextureKind::kNumbers, &MaterialTextures::leaf_alpha},
     {"leaf_reflectance", TextureKind::kColour, &MaterialTextures::leaf_reflectance},
     {"leaf_thickness", TextureKind::kNumbers, &MaterialTextures::leaf_thickness},
     {"leaf_normal", TextureKind::kNumbers, &MaterialTextures::leaf_normal},
     {"bark", TextureKind::kColour, &MaterialTextures::bark}}};

// What the ground is covered with: its colour; its albedo in the band is the scene's.
enum class GroundCover { kLitter, kGrass };

struct PictureLook {
  LeafOutline outline = LeafOutline::kBySpecies;  // of flat leaves but triangles, whose shape is their own
  bool patterns = true;                           // veins, bark, litter, made by formula
  double leaf_gloss = 0.0;       // share of a front face's reflectance that is specular, 0 .. 1
  double gloss_exponent = 20.0;  // of its lobe, 1 .. 1000
  double bark_width_m = 0.5;     // width of a bark image on the stem
  GroundCover ground = GroundCover::kLitter;
  std::vector<MaterialTextures> textures;
  ShootForm shoots = ShootForm::kVolume;  // how conifers are drawn
  std::vector<NeedleKind> needles{};      // of the species, for other forms than kVolume
};

// Everything as the light was computed: for comparisons and measurements.
inline PictureLook plain_look() {
  return {.outline = LeafOutline::kAsModelled, .patterns = false, .textures = {}};
}

}  // namespace sunfleck
