// Renders tile by tile. Every sample draws from the stream of its own (pixel, sample), so the picture is the
// same for any number of threads. Layers other than colour come from one ray through the pixel's centre.
#include "lighting/render/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "lighting/render/camera_rays.h"
#include "lighting/render/shader.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

constexpr int kTilePx = 64;

struct Tile {
  int x0, y0, x1, y1;
};

struct View {
  const Camera& camera;
  const CameraRays& rays;
  const RayScene& scene;
  const Shader& shader;
  const LightMap& map;
};

void refuse_map(const std::string& problem) {
  throw_invalid("map", problem, "give the light map that was computed for this forest and these bands");
}

std::string counts(std::size_t found, const char* what, std::size_t wanted) {
  return "has " + std::to_string(found) + " " + what + ", " + std::to_string(wanted) + " are needed";
}

void require_match(const ForestIndex& index, const OpticsTable& optics, const LightMap& map) {
  if (map.bands.size() != optics.band_count())
    refuse_map(counts(map.bands.size(), "bands", optics.band_count()));
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    const BandLightMap& band = map.bands[b];
    if (band.band != optics.bands()[b])
      refuse_map("has band " + band.band + " where the optics have " + optics.bands()[b]);
    if (band.elements.size() != index.element_count())
      refuse_map(counts(band.elements.size(), "elements", index.element_count()));
  }
}

Image empty_image(const Camera& camera) {
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  Image image;
  image.width_px = camera.width_px;
  image.height_px = camera.height_px;
  image.rgb.assign(3 * pixels, 0.0f);
  image.rgb_standard_error.assign(pixels, 0.0f);
  image.depth_m.assign(pixels, std::numeric_limits<float>::infinity());
  image.normal.assign(3 * pixels, 0.0f);
  image.instance_id.assign(pixels, -1.0f);
  image.irradiance_w_m2.assign(pixels, 0.0f);
  return image;
}

std::vector<Tile> tiles_of(const Camera& camera) {
  std::vector<Tile> tiles;
  for (int y = 0; y < camera.height_px; y += kTilePx)
    for (int x = 0; x < camera.width_px; x += kTilePx)
      tiles.push_back(
          {x, y, std::min(x + kTilePx, camera.width_px), std::min(y + kTilePx, camera.height_px)});
  return tiles;
}

Vec3 sample(const View& view, int x, int y, RandomStream& random) {
  const double dx = random.uniform(), dy = random.uniform();
  const auto ray = view.rays.through(x + dx, y + dy);
  if (!ray) return Vec3(0.0);
  return view.shader.radiance(view.scene.closest_hit(ray->origin_m, ray->direction), ray->direction, random);
}

// Mean and variance of a growing sample, by updates (Welford 1962): never a difference of large sums.
struct RunningMean {
  int count = 0;
  double mean = 0, squares = 0;
  void add(double value) {
    ++count;
    const double step = value - mean;
    mean += step / count;
    squares += step * (value - mean);
  }
  double standard_error() const { return count > 1 ? std::sqrt(squares / (count - 1.0) / count) : 0.0; }
};

void shade_pixel(const View& view, int x, int y, std::size_t pixel, const RunControl& control, Image& image) {
  const int samples = view.camera.samples_per_pixel;
  Vec3 sum(0.0);
  RunningMean grey;
  for (int s = 0; s < samples; ++s) {
    control.check();
    RandomStream random(view.camera.seed,
                        pixel * static_cast<std::size_t>(samples) + static_cast<std::size_t>(s),
                        RandomPurpose::kCamera);
    const Vec3 colour = sample(view, x, y, random);
    sum += colour;
    grey.add((colour.x + colour.y + colour.z) / 3.0);
  }
  for (int c = 0; c < 3; ++c)
    image.rgb[3 * pixel + static_cast<std::size_t>(c)] = static_cast<float>(sum[c] / samples);
  image.rgb_standard_error[pixel] = static_cast<float>(grey.standard_error());
}

void look_through_centre(const View& view, int x, int y, std::size_t pixel, Image& image) {
  const auto ray = view.rays.through(x + 0.5, y + 0.5);
  if (!ray) return;
  const RayHit hit = view.scene.closest_hit(ray->origin_m, ray->direction);
  if (hit.kind == HitKind::kSky) return;
  image.depth_m[pixel] = static_cast<float>(hit.distance_m);
  for (int c = 0; c < 3; ++c)
    image.normal[3 * pixel + static_cast<std::size_t>(c)] = static_cast<float>(hit.normal[c]);
  if (hit.kind == HitKind::kGround) return;
  image.instance_id[pixel] = static_cast<float>(hit.instance);
  if (hit.kind != HitKind::kFoliage) return;
  const ElementLight& light = view.map.bands.front().elements[view.shader.element_of(hit)];
  image.irradiance_w_m2[pixel] = light.front.total() + light.back.total();
}

void render_tile(const View& view, const Tile& tile, const RunControl& control, Image& image) {
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px) +
                                static_cast<std::size_t>(x);
      look_through_centre(view, x, y, pixel, image);
      shade_pixel(view, x, y, pixel, control, image);
    }
}

}  // namespace

Image render(const Forest& forest, const OpticsTable& optics, const LightMap& map,
             const RenderRequest& request, const RunControl& control, const TileSink& tiles) {
  validate(request.camera);
  const Illumination light = checked(request.light, optics.band_count());
  const ForestIndex index(forest);
  require_match(index, optics, map);
  control.check();
  const RayScene scene(forest, {});
  const Shader shader(forest, index, optics, map, light, scene);
  const CameraRays rays(request.camera);
  const View view{request.camera, rays, scene, shader, map};

  Image image = empty_image(request.camera);
  const std::vector<Tile> plan = tiles_of(request.camera);
  std::mutex telling;
  for_each_chunk(plan.size(), 1, control, "rendering", [&](std::size_t t, std::size_t) {
    render_tile(view, plan[t], control, image);
    if (!tiles) return;
    const std::lock_guard lock(telling);
    tiles(image, plan[t].x0, plan[t].y0, plan[t].x1, plan[t].y1);
  });
  return image;
}

}  // namespace sunfleck
