#include <algorithm>
#include <cstdio>
#include <vector>

#include "lighting/map/light_map_file.h"
#include "lighting/render/camera_config.h"
#include "lighting/render/render.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/grid/forest_file.h"

namespace sunfleck {
namespace {

// The median over the pixels that show light of their standard error, relative to their own brightness.
double median_noise(const Image& image) {
  std::vector<double> noise;
  for (std::size_t p = 0; p < image.rgb_standard_error.size(); ++p) {
    const double mean =
        (static_cast<double>(image.rgb[3 * p]) + image.rgb[3 * p + 1] + image.rgb[3 * p + 2]) / 3;
    if (mean > 0) noise.push_back(image.rgb_standard_error[p] / mean);
  }
  if (noise.empty()) return 0;
  std::nth_element(noise.begin(), noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 2), noise.end());
  return noise[noise.size() / 2];
}

// A picture's leaves, ground and sky must be lit by the same sun, and the leaves must be this forest's.
void check_belongs(const LightMap& map, const Forest& forest, const LightRequest& light,
                   const std::string& where) {
  if (map.provenance.forest_hash != content_hash(forest))
    throw_invalid(where, "was made for another forest (" + map.provenance.forest_hash + ")",
                  "a light map of this one (" + content_hash(forest) + ")");
  for (const auto& [name, value] : describe_light(forest, light))
    for (const auto& [made_name, made_value] : map.provenance.settings)
      if (name == made_name && value != made_value)
        throw_invalid(where, "was made with " + name + " = " + made_value, "the scene file says " + value);
}

}  // namespace

void run_render(const RenderOptions& o, const RunControl& control) {
  check_outputs("render", {{"--png", o.png, ".png"}, {"--exr", o.exr, ".exr"}});
  const SceneFile scene = read_scene_file(o.scene);
  if (!scene.light) throw_invalid(o.scene.string(), "has no [light] table", "the sun and sky of the picture");
  const Forest forest = load_forest(o.forest);
  const LightMap map = load_netcdf(o.light_map);
  check_belongs(map, forest, *scene.light, o.light_map.string());
  const OpticsTable optics(forest, scene.light->optics);
  const RenderRequest request{scene.camera ? *scene.camera : default_camera(forest_bounds(forest)),
                              checked(scene.light->light, optics.band_count())};
  const Image image = render(forest, optics, map, request, control);
  if (!o.png.empty()) save_png(image, o.png);
  if (!o.exr.empty()) save_exr(image, o.exr);
  finish_progress();
  std::printf(
      "image        %d x %d pixels, %d samples each; standard error of a pixel %.1f %% of its brightness "
      "(median)\n",
      image.width_px, image.height_px, request.camera.samples_per_pixel, 100 * median_noise(image));
  for (const auto& path : {o.png, o.exr})
    if (!path.empty()) std::printf("wrote        %s\n", path.c_str());
}

}  // namespace sunfleck
