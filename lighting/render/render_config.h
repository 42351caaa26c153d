// The [render] table of a scene file.
#pragma once

#include "lighting/render/render.h"
#include "sim/config/config_table.h"

namespace sunfleck {

enum class RenderMode { kLightMap, kPathTraced };
std::string to_string(RenderMode mode);  // "light_map", "path_traced"
// Throws Error(kInvalidInput) at `where` for another word.
RenderMode render_mode_named(const std::string& word, const std::string& where);

std::string to_string(LeafSun sun);         // "stored", "traced", "tile"
std::string to_string(GroundCover ground);  // "litter", "grass"
std::string to_string(ToneCurve curve);     // "linear", "filmic"
std::string to_string(ShootForm form);      // "volume", "explicit", "bough"
// Throws likewise.
LeafSun leaf_sun_named(const std::string& word, const std::string& where);

struct RenderSettings {
  RenderMode mode = RenderMode::kLightMap;
  PictureLook look;
  RenderEffort effort;
  LeafSun leaf_sun = LeafSun::kTraced;
  PictureDetail detail;
  ToneMap tone;
};

// What a picture with these settings is asked for; the mode chooses the function that answers.
RenderRequest picture_request(const RenderSettings& settings, const Camera& camera,
                              const Illumination& light);

// Keys: mode ("light_map", "path_traced"), noise, max_samples_per_pixel, leaf_sun ("traced", "stored",
// "tile"), detail ("full", "auto", "pruned_4", "pruned_16", "pruned_64"), detail_tolerance,
// leaf_outline ("by_species", "as_modelled", "ovate", "lobed", "needle"), patterns, leaf_gloss,
// ground ("litter", "grass"), gloss_exponent, bark_width_m, tone ("linear", "filmic"), exposure_stops, and
// [[render.textures]]: material, leaf_alpha, leaf_reflectance, leaf_thickness, leaf_normal, bark (image
// files, relative to the scene file). Others are refused.
RenderSettings read_render_settings(const ConfigTable& table);

}  // namespace sunfleck
