#include <cmath>
#include <cstdio>

#include "lighting/map/light_map_file.h"
#include "lighting/render/camera_config.h"
#include "lighting/render/render.h"
#include "server/apps/commands.h"
#include "server/apps/scene_file.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/grid/forest_file.h"

namespace sunfleck {
namespace {

// RMS over the pixels of the standard error, and the mean brightness it belongs to.
void print_image(const Image& image, int samples) {
  double squares = 0.0, mean = 0.0;
  for (const float e : image.rgb_standard_error) squares += static_cast<double>(e) * e;
  for (const float c : image.rgb) mean += c;
  const double pixels = static_cast<double>(image.rgb_standard_error.size());
  std::printf("image        %d x %d pixels, %d samples each; noise %.1f %% of the mean brightness (RMS)\n",
              image.width_px, image.height_px, samples,
              mean > 0 ? 100 * std::sqrt(squares / pixels) / (mean / (3 * pixels)) : 0.0);
}

}  // namespace

void run_render(const RenderOptions& o, const RunControl& control) {
  if (o.png.empty() && o.exr.empty()) throw_invalid("render", "nowhere to write", "--png FILE or --exr FILE");
  const SceneFile scene = read_scene_file(o.scene);
  if (!scene.light) throw_invalid(o.scene.string(), "has no [light] table", "the sun and sky of the picture");
  const Forest forest = load_forest(o.forest);
  const LightMap map = load_netcdf(o.light_map);
  const OpticsTable optics(forest, scene.light->optics);
  const RenderRequest request{scene.camera ? *scene.camera : default_camera(forest),
                              checked(scene.light->light, optics.band_count())};
  const Image image = render(forest, optics, map, request, control);
  if (!o.png.empty()) save_png(image, o.png);
  if (!o.exr.empty()) save_exr(image, o.exr);
  finish_progress();
  print_image(image, request.camera.samples_per_pixel);
  for (const auto& path : {o.png, o.exr})
    if (!path.empty()) std::printf("wrote        %s\n", path.c_str());
}

}  // namespace sunfleck
