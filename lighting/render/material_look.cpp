#include "lighting/render/material_look.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr int kMeanSide = 256;  // points per side that means over a leaf are taken at
constexpr double kStops = 2.0;  // optical depth of a thickness of 1

std::optional<TextureImage> load(const MaterialTextures& textures, const char* name) {
  const auto slot = std::find_if(kTextureSlots.begin(), kTextureSlots.end(),
                                 [&](const TextureSlot& s) { return std::string_view(s.name) == name; });
  const std::string where = textures.where.empty() ? name : textures.where + "." + name;
  const auto given = textures.given.find(name);
  if (given != textures.given.end()) return decoded(*given->second, slot->kind, where);
  const std::filesystem::path& file = textures.*slot->file;
  if (file.empty()) return std::nullopt;
  return load_texture(file, slot->kind, where);
}

// Leaf images stand upright: x along the leaf is upwards in the image, y > 0 (left of the tip) is left.
Vec2 image_place(const Vec2& at) { return {0.5 * (1.0 - at.y), 0.5 * (1.0 + at.x)}; }

Vec3 mean_colour(const TextureImage& image) {
  Vec3 sum(0.0);
  const auto pixels = static_cast<double>(image.width_px) * image.height_px;
  for (int row = 0; row < image.height_px; ++row)
    for (int column = 0; column < image.width_px; ++column)
      sum += image.colour({(column + 0.5) / image.width_px, (row + 0.5) / image.height_px},
                          TextureEdge::kRepeat);
  return sum / pixels;
}

Vec3 ratio(const Vec3& value, const Vec3& mean) {
  Vec3 result(1.0);
  for (int c = 0; c < 3; ++c)
    if (mean[c] > 0.0) result[c] = value[c] / mean[c];
  return result;
}

double lattice_value(double x, double y, std::uint64_t seed) {
  const auto bits = [](double v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)); };
  return static_cast<double>(mix_seed(mix_seed(seed, bits(x)), bits(y)) >> 11) * 0x1p-52 - 1.0;
}

double smooth(double t) { return t * t * (3.0 - 2.0 * t); }

}  // namespace

double lattice_noise(const Vec2& at, std::uint64_t seed) {
  const double x = std::floor(at.x), y = std::floor(at.y);
  const double u = smooth(at.x - x), v = smooth(at.y - y);
  return std::lerp(std::lerp(lattice_value(x, y, seed), lattice_value(x + 1, y, seed), u),
                   std::lerp(lattice_value(x, y + 1, seed), lattice_value(x + 1, y + 1, seed), u), v);
}

namespace {

// Noise of one size as its mean over a footprint.
double noise_seen(const Vec2& at_m, const Vec2& size_m, std::uint64_t seed, double footprint_m) {
  constexpr double kNothing = 0.02;
  const double kept = 1.0 / (1.0 + footprint_m * footprint_m / (size_m.x * size_m.y));
  return kept > kNothing ? kept * lattice_noise(at_m / size_m, seed) : 0.0;
}

}  // namespace

Vec3 litter_pattern(const Vec2& at, double footprint_m) {
  const auto noise = [&](double size_m, std::uint64_t seed) {
    return noise_seen(at, Vec2(size_m), seed, footprint_m);
  };
  const double patches = 0.22 * noise(2.3, 1) + 0.16 * noise(0.6, 2);
  const double litter = 0.28 * noise(0.11, 3) + 0.2 * noise(0.04, 4);
  const double warmth = 0.1 * noise(0.9, 5) + 0.06 * noise(0.08, 6);
  return Vec3(1.0 + patches + litter) * Vec3(1.0 + warmth, 1.0, 1.0 - warmth);
}

MaterialLook::MaterialLook(const PictureLook& look, const std::string& material,
                           const MaterialTextures* textures)
    : outline_(look.outline == LeafOutline::kBySpecies ? outline_of(material) : look.outline),
      patterns_(look.patterns),
      bark_width_m_(look.bark_width_m) {
  if (textures != nullptr) {
    alpha_ = load(*textures, "leaf_alpha");
    reflectance_ = load(*textures, "leaf_reflectance");
    thickness_ = load(*textures, "leaf_thickness");
    normal_ = load(*textures, "leaf_normal");
    bark_ = load(*textures, "bark");
  }
  if (alpha_)
    aspect_ = static_cast<double>(alpha_->height_px) / alpha_->width_px;
  else if (changes_outline())
    aspect_ = natural_aspect(outline_);
  take_means();
  if (share_ <= 0.0)
    throw_invalid(textures->where,
                  "leaf_alpha '" + textures->leaf_alpha.string() + "' is transparent everywhere",
                  "an image with a leaf in it");
}

void MaterialLook::take_means() {
  Vec3 reflect(0.0);
  double pass = 0.0, inside = 0.0;
  for (int i = 0; i < kMeanSide; ++i)
    for (int j = 0; j < kMeanSide; ++j) {
      const Vec2 at(2.0 * (i + 0.5) / kMeanSide - 1.0, 2.0 * (j + 0.5) / kMeanSide - 1.0);
      if (!is_inside(at)) continue;
      inside += 1.0;
      reflect += raw_reflect(at);
      pass += raw_pass(at);
    }
  share_ = inside / (kMeanSide * kMeanSide);
  if (!alpha_ && changes_outline()) share_ = outline_share(outline_);
  if (inside > 0.0) mean_reflect_ = reflect / inside, mean_pass_ = pass / inside;
  if (bark_) mean_bark_ = mean_colour(*bark_);
}

bool MaterialLook::is_inside(const Vec2& at) const {
  if (alpha_) return alpha_->alpha(image_place(at), TextureEdge::kClamp) >= 0.5;
  return inside_leaf(outline_, at);
}

Vec3 MaterialLook::raw_reflect(const Vec2& at) const {
  if (reflectance_) return reflectance_->colour(image_place(at), TextureEdge::kClamp);
  if (!patterns_ || alpha_ || outline_ == LeafOutline::kAsModelled) return Vec3(1.0);
  return Vec3(vein_pattern(outline_, at).reflect);
}

double MaterialLook::raw_pass(const Vec2& at) const {
  if (thickness_) return std::exp(-kStops * thickness_->at(image_place(at), 0, TextureEdge::kClamp));
  if (!patterns_ || alpha_ || outline_ == LeafOutline::kAsModelled) return 1.0;
  return vein_pattern(outline_, at).pass;
}

Vec3 MaterialLook::leaf_reflect(const Vec2& at) const { return ratio(raw_reflect(at), mean_reflect_); }
Vec3 MaterialLook::leaf_pass(const Vec2& at) const {
  return mean_pass_ > 0.0 ? Vec3(raw_pass(at) / mean_pass_) : Vec3(1.0);
}

Vec3 MaterialLook::leaf_normal(const Vec2& at) const {
  if (!normal_) return {0, 0, 1};
  // Red points to the right of the image (-y of the leaf), green upwards (+x).
  const Vec3 n = 2.0 * normal_->colour(image_place(at), TextureEdge::kClamp) - 1.0;
  const Vec3 turned(n.y, -n.x, std::max(n.z, 1e-3));
  return glm::normalize(turned);
}

double MaterialLook::leaf_pattern_left(double stretch) const {
  const bool images = reflectance_ || thickness_;
  const double whole = images ? 0.1 : 0.03, none = images ? 0.5 : 0.15;
  return std::clamp((none - stretch) / (none - whole), 0.0, 1.0);
}

Vec3 MaterialLook::bark(const Vec2& at_m, double footprint_m) const {
  if (bark_) {
    if (footprint_m > bark_width_m_) return Vec3(1.0);
    const double height_m = bark_width_m_ * bark_->height_px / bark_->width_px;
    const Vec2 place = at_m / Vec2(bark_width_m_, height_m);
    return ratio(bark_->colour(place - glm::floor(place), TextureEdge::kRepeat), mean_bark_);
  }
  if (!patterns_) return Vec3(1.0);
  // Furrows along the stem, broken every few decimetres.
  const auto noise = [&](const Vec2& size_m, std::uint64_t seed) {
    return noise_seen(at_m, size_m, seed, footprint_m);
  };
  const double furrows = 0.35 * noise({0.025, 0.16}, 7);
  const double blotches = 0.2 * noise(Vec2(0.35), 8) + 0.12 * noise(Vec2(0.012), 9);
  return Vec3(1.0 + furrows + blotches);
}

}  // namespace sunfleck
