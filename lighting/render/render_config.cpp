#include "lighting/render/render_config.h"

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

template <class Choice>
struct Word {
  Choice choice;
  const char* word;
};
constexpr Word<RenderMode> kModes[] = {{RenderMode::kLightMap, "light_map"},
                                       {RenderMode::kPathTraced, "path_traced"}};
constexpr Word<LeafSun> kLeafSuns[] = {
    {LeafSun::kTraced, "traced"}, {LeafSun::kStored, "stored"}, {LeafSun::kTile, "tile"}};
constexpr Word<Visibility> kVisibilities[] = {
    {Visibility::kAuto, "auto"}, {Visibility::kRays, "rays"}, {Visibility::kRaster, "raster"}};
constexpr Word<ShootForm> kShootForms[] = {
    {ShootForm::kVolume, "volume"}, {ShootForm::kNeedles, "explicit"}, {ShootForm::kBough, "bough"}};

template <class Choice, std::size_t count>
std::string word_of(const Word<Choice> (&words)[count], Choice choice) {
  for (const auto& w : words)
    if (w.choice == choice) return w.word;
  SUNFLECK_EXPECTS(false);
  return {};
}

template <class Choice, std::size_t count>
Choice named(const Word<Choice> (&words)[count], const std::string& word, const std::string& where) {
  std::string known = words[0].word;
  for (std::size_t i = 0; i < count; ++i) {
    if (word == words[i].word) return words[i].choice;
    if (i > 0) known += (i + 1 == count ? " or " : ", ") + std::string(words[i].word);
  }
  throw_invalid(where, "is '" + word + "'", known);
}

std::filesystem::path read_path(const ConfigTable& table, const char* key) {
  const std::string text = table.text_or(key, "");
  return text.empty() ? std::filesystem::path{} : table.directory() / text;
}

MaterialTextures read_textures(const ConfigTable& table) {
  MaterialTextures t;
  t.material = table.text_or("material", "*");
  for (const TextureSlot& slot : kTextureSlots) t.*slot.file = read_path(table, slot.name);
  t.where = table.where("material");
  const std::size_t last = t.where.rfind(".material");
  if (last != std::string::npos) t.where.erase(last);
  return t;
}

LeafOutline read_outline(const ConfigTable& table) {
  const std::string word = table.choice_or("leaf_outline", "by_species",
                                           {"by_species", "as_modelled", "ovate", "lobed", "needle"});
  for (const LeafOutline o :
       {LeafOutline::kAsModelled, LeafOutline::kOvate, LeafOutline::kLobed, LeafOutline::kNeedle})
    if (word == to_string(o)) return o;
  return LeafOutline::kBySpecies;
}

}  // namespace

std::string to_string(GroundCover ground) { return ground == GroundCover::kGrass ? "grass" : "litter"; }
std::string to_string(ToneCurve curve) { return curve == ToneCurve::kFilmic ? "filmic" : "linear"; }

RenderMode render_mode_named(const std::string& word, const std::string& where) {
  return named(kModes, word, where);
}
LeafSun leaf_sun_named(const std::string& word, const std::string& where) {
  return named(kLeafSuns, word, where);
}
Visibility visibility_named(const std::string& word, const std::string& where) {
  return named(kVisibilities, word, where);
}
ShootForm shoot_form_named(const std::string& word, const std::string& where) {
  return named(kShootForms, word, where);
}

std::string to_string(RenderMode mode) { return word_of(kModes, mode); }
std::string to_string(LeafSun sun) { return word_of(kLeafSuns, sun); }
std::string to_string(Visibility visibility) { return word_of(kVisibilities, visibility); }
std::string to_string(ShootForm form) { return word_of(kShootForms, form); }

RenderRequest picture_request(const RenderSettings& settings, const Camera& camera,
                              const Illumination& light) {
  return {
      camera, light, settings.look, settings.effort, settings.leaf_sun, settings.detail, settings.visibility};
}

RenderSettings read_render_settings(const ConfigTable& table) {
  RenderSettings s;
  s.mode = render_mode_named(table.text_or("mode", "light_map"), table.where("mode"));
  s.effort.noise = table.number_or("noise", 0.0, {0.0, 1.0});
  s.effort.max_samples_per_pixel =
      static_cast<int>(table.integer_or("max_samples_per_pixel", 4096, {1, 1 << 20}));
  s.leaf_sun = leaf_sun_named(table.text_or("leaf_sun", "traced"), table.where("leaf_sun"));
  s.visibility = visibility_named(table.text_or("visibility", "rays"), table.where("visibility"));
  s.detail = picture_detail_named(table.text_or("detail", "full"), table.where("detail"));
  s.detail.tolerance = table.number_or("detail_tolerance", s.detail.tolerance, {1e-6, 1.0});
  s.look.outline = read_outline(table);
  s.look.patterns = table.boolean_or("patterns", true);
  s.look.ground = table.choice_or("ground", "litter", {"litter", "grass"}) == "grass" ? GroundCover::kGrass
                                                                                      : GroundCover::kLitter;
  s.look.leaf_gloss = table.number_or("leaf_gloss", 0.0, {0.0, 1.0});
  s.look.gloss_exponent = table.number_or("gloss_exponent", 20.0, {1.0, 1000.0});
  s.look.bark_width_m = table.number_or("bark_width_m", 0.5, {1e-3, 100.0});
  for (const ConfigTable& t : table.tables("textures")) s.look.textures.push_back(read_textures(t));
  s.look.shoots = shoot_form_named(table.text_or("needles", "volume"), table.where("needles"));
  s.tone.curve = table.choice_or("tone", "linear", {"linear", "filmic"}) == "filmic" ? ToneCurve::kFilmic
                                                                                     : ToneCurve::kLinear;
  s.tone.exposure_stops = table.number_or("exposure_stops", 0.0, {-20.0, 20.0});
  return s;
}

}  // namespace sunfleck
