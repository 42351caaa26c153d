// Pictures from a light map by rays and by rasterising, and path-traced ones, of a scene file: their CPU time
// and how far they are from converged ones.
//   lighting_render_raster forest.vdb light.nc scene.toml [width [converged samples [folder [samples]]]]
// With 0 converged samples: times alone.
// Prints, for 4, 16 and 64 samples per pixel, the median CPU time of three runs, the mean absolute difference
// to the converged path-traced picture and SSIM, then time ratios: at the same samples, and at equal error
// (the path tracer's samples for the error of the picture compared, by its error falling as the root of
// samples). With a folder: the pictures as PNG.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "lighting/map/light_map_file.h"
#include "lighting/plan/light_config.h"
#include "lighting/render/camera_config.h"
#include "lighting/render/image_difference.h"
#include "lighting/render/render_config.h"
#include "sim/base/error.h"
#include "sim/config/config_table.h"
#include "sim/grid/forest_file.h"

namespace {

using namespace sunfleck;

double cpu_s() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

struct Scene {
  const Forest& forest;
  const LightMap& map;
  const OpticsTable& optics;
  RenderRequest request;
  ToneMap tone;
};

enum class Way { kPaths, kRays, kRaster };
constexpr std::array<const char*, 3> kNames = {"paths", "rays", "raster"};

Image picture(const Scene& scene, Way way, int samples, std::uint64_t seed) {
  RenderRequest request = scene.request;
  request.camera.samples_per_pixel = samples;
  request.camera.seed = seed;
  request.visibility = way == Way::kRaster ? Visibility::kRaster : Visibility::kRays;
  return way == Way::kPaths ? render_path_traced(scene.forest, scene.optics, request, {})
                            : render(scene.forest, scene.optics, scene.map, request, {});
}

struct Timed {
  Image image;
  double cpu_s;
};
Timed timed(const Scene& scene, Way way, int samples) {
  std::vector<double> times;
  Image image;
  for (int run = 0; run < (way == Way::kRaster ? 3 : 1); ++run) {
    const double began = cpu_s();
    image = picture(scene, way, samples, 1);
    times.push_back(cpu_s() - began);
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  return {std::move(image), times[times.size() / 2]};
}

void compare(const Scene& scene, const Image& paths, const Image& rays, const std::string& folder) {
  for (const int samples : {4, 16, 64}) {
    std::array<double, 3> time{}, error{};
    for (const Way way : {Way::kPaths, Way::kRays, Way::kRaster}) {
      const auto w = static_cast<std::size_t>(way);
      const Timed t = timed(scene, way, samples);
      const ImageDifference to_paths = image_difference(t.image, paths),
                            to_rays = image_difference(t.image, rays);
      time[w] = t.cpu_s, error[w] = to_paths.mean_absolute;
      std::printf(
          "%-6s %3d samples: %7.3f s CPU, to path-traced %+5.2f / %5.2f %%, SSIM %.4f; to rays %+5.2f / "
          "%5.2f %%\n",
          kNames[w], samples, t.cpu_s, 100 * to_paths.bias, 100 * to_paths.mean_absolute, to_paths.ssim,
          100 * to_rays.bias, 100 * to_rays.mean_absolute);
      if (!folder.empty())
        save_png(t.image, folder + "/" + kNames[w] + std::to_string(samples) + ".png", scene.tone),
            save_exr(t.image, folder + "/" + kNames[w] + std::to_string(samples) + ".exr");
    }
    for (const std::size_t w : {1u, 2u})
      std::printf(
          "%-6s %3d samples: %.1f times less than paths of as many samples, %.1f times at equal error\n",
          kNames[w], samples, time[0] / time[w], time[0] * std::pow(error[0] / error[w], 2) / time[w]);
  }
}

Image converged(const Scene& scene, Way way, int samples) {
  const double began = cpu_s();
  Image image = picture(scene, way, samples, 77);
  std::printf("%-6s %d samples: %.1f s CPU, noise %.2f %%\n", kNames[static_cast<std::size_t>(way)], samples,
              cpu_s() - began, 100 * image_noise(image));
  return image;
}

int run(int argc, char** argv) {
  if (argc < 4) return 2;
  const ConfigTable root = ConfigTable::from_file(argv[3]);
  const LightRequest light = read_light_request(root.table("light"));
  const RenderSettings look =
      root.table_if("render") ? read_render_settings(root.table("render")) : RenderSettings{};
  const Forest forest = load_forest(argv[1]);
  const LightMap map = load_netcdf(argv[2]);
  const OpticsTable optics(forest, light.optics);
  Camera camera = read_camera(root.table("camera"));
  if (argc > 4) {
    camera.height_px = camera.height_px * std::atoi(argv[4]) / camera.width_px;
    camera.width_px = std::atoi(argv[4]);
  }
  if (argc > 7) camera.samples_per_pixel = std::atoi(argv[7]);
  const int samples = argc > 5 ? std::atoi(argv[5]) : 512;
  const Scene scene{forest,
                    map,
                    optics,
                    {camera, checked(light.light, optics.band_count()), look.look, {}, look.leaf_sun},
                    look.tone};
  if (samples == 0) {  // times alone, at the scene's samples; paths from four samples
    const Timed raster = timed(scene, Way::kRaster, camera.samples_per_pixel);
    const double paths_s = timed(scene, Way::kPaths, 4).cpu_s * camera.samples_per_pixel / 4;
    std::printf("%d x %d, %d samples: raster %.3f s CPU, paths %.2f s, %.1f times\n", camera.width_px,
                camera.height_px, camera.samples_per_pixel, raster.cpu_s, paths_s, paths_s / raster.cpu_s);
    return 0;
  }
  const Image rays = converged(scene, Way::kRays, samples), paths = converged(scene, Way::kPaths, samples);
  const ImageDifference d = image_difference(rays, paths);
  std::printf("converged rays to paths %+.2f / %.2f %%, SSIM %.4f\n", 100 * d.bias, 100 * d.mean_absolute,
              d.ssim);
  const std::string folder = argc > 6 ? argv[6] : "";
  if (!folder.empty())
    save_png(paths, folder + "/converged_paths.png", scene.tone),
        save_png(rays, folder + "/converged_rays.png", scene.tone);
  compare(scene, paths, rays, folder);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const sunfleck::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
