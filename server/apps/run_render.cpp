#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "lighting/map/light_map_file.h"
#include "lighting/render/camera_config.h"
#include "lighting/render/render_config.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/picture_forest.h"
#include "server/apps/scene_file.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"

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
void check_belongs(const LightMap& map, const PictureForest& picture, const LightRequest& light,
                   const std::string& where) {
  if (map.provenance.forest_hash != picture.content_hash)
    throw_invalid(where, "was made for another forest (" + map.provenance.forest_hash + ")",
                  "a light map of this one (" + picture.content_hash + ")");
  for (const auto& [name, value] : describe_light(picture.forest, light))
    for (const auto& [made_name, made_value] : map.provenance.settings)
      if (name == made_name && value != made_value)
        throw_invalid(where, "was made with " + name + " = " + made_value, "the scene file says " + value);
}

Image make_image(const RenderOptions& o, const SceneFile& scene, const PictureForest& picture,
                 RenderMode mode, const RunControl& control) {
  const OpticsTable optics(picture.forest, scene.light->optics);
  if (mode == RenderMode::kPathTraced)
    return render_path_traced(picture.forest, optics, picture.request, control);
  if (o.light_map.empty())
    throw_invalid("--light-map", "is missing", "the light map of this forest, or --mode path_traced");
  LightMap map = load_netcdf(o.light_map);
  check_belongs(map, picture, *scene.light, o.light_map.string());
  return render(picture.forest, optics, picture.light(std::move(map)), picture.request, control);
}

void print_summary(const Image& image, RenderMode mode, double wall_s) {
  std::printf("image        %d x %d pixels, %s, %d samples each, %.1f s\n", image.width_px, image.height_px,
              mode == RenderMode::kPathTraced ? "path-traced" : "from the light map", image.samples_per_pixel,
              wall_s);
  std::printf(
      "noise        %.2f %% of the picture's mean brightness (RMS of its pixels); median pixel %.1f %% "
      "of its own\n",
      100 * image_noise(image), 100 * median_noise(image));
}

// "detail       12 trees explicit, 30 pruned_4"; nothing where all have every leaf.
void print_detail(const Image& image) {
  std::string line;
  for (int d = 0; d < kDetails; ++d) {
    const std::size_t trees = image.trees_at[static_cast<std::size_t>(d)];
    if (trees == 0) continue;
    line += (line.empty() ? "" : ", ") + std::to_string(trees) + " " + to_string(static_cast<Detail>(d));
  }
  std::printf("detail       trees: %s\n", line.c_str());
}

}  // namespace

void run_render(const RenderOptions& o, const RunControl& control) {
  check_outputs("render", {{"--png", o.png, ".png"}, {"--exr", o.exr, ".exr"}});
  const SceneFile scene = read_scene_file(o.scene);
  if (!scene.light) throw_invalid(o.scene.string(), "has no [light] table", "the sun and sky of the picture");
  RenderSettings settings = scene.render.value_or(RenderSettings{});
  if (!o.mode.empty()) settings.mode = render_mode_named(o.mode, "--mode");
  if (!o.leaf_sun.empty()) settings.leaf_sun = leaf_sun_named(o.leaf_sun, "--leaf-sun");
  settings.effort.keep_when_stopped = settings.mode == RenderMode::kPathTraced;
  if (settings.look.shoots != ShootForm::kVolume)
    settings.look.needles = needle_kinds(SpeciesLibrary::load(find_configs({}) / "species"));
  const auto began_loading = std::chrono::steady_clock::now();
  const PictureForest picture = load_for_picture(o.forest, settings.mode, o.far_light, [&](const Box& box) {
    return picture_request(settings, scene.camera ? *scene.camera : default_camera(box),
                           checked(scene.light->light, scene.light->optics.bands.size()));
  });
  const auto began = std::chrono::steady_clock::now();
  const Image image = make_image(o, scene, picture, settings.mode, control);
  const std::chrono::duration<double> wall_s = std::chrono::steady_clock::now() - began;
  if (!o.png.empty()) save_png(image, o.png, settings.tone);
  if (!o.exr.empty()) save_exr(image, o.exr);
  finish_progress();
  const std::chrono::duration<double> load_s = began - began_loading;
  std::printf("loaded       %s; %.1f s\n", picture.note.c_str(), load_s.count());
  print_summary(image, settings.mode, wall_s.count());
  if (settings.detail.mode != DetailMode::kFull) print_detail(image);
  for (const auto& path : {o.png, o.exr})
    if (!path.empty()) std::printf("wrote        %s\n", path.c_str());
  if (image.stopped) throw_cancelled();
}

}  // namespace sunfleck
