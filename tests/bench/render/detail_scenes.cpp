#include "tests/bench/render/detail_scenes.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "lighting/render/camera_rays.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "sim/plant/make_prototype.h"
#include "tests/support/golden.h"

namespace sunfleck::test {
namespace {

constexpr double kDbhCm = 30;

struct Kind {
  Material material;
  Prototype prototype;
};

Kind kind_named(const std::string& name) {
  if (name == "sphere_100k") {
    const Forest crown = generated_crown({CrownKind::kSphere, 100000, 1, 5, 3});
    return {crown.materials[0], crown.prototypes[0]};
  }
  const SpeciesLibrary library = SpeciesLibrary::load(source_dir() / "configs" / "species");
  const Species& species = library.find(name, "bench");
  return {species.material, grow_prototype(species, expected_size(species, kDbhCm), 3, 1.0)};
}

double brightest(const Image& image, std::size_t p) {
  return std::max({image.rgb[3 * p], image.rgb[3 * p + 1], image.rgb[3 * p + 2]});
}
double mean_of(const Image& image, std::size_t p) {
  return (static_cast<double>(image.rgb[3 * p]) + image.rgb[3 * p + 1] + image.rgb[3 * p + 2]) / 3.0;
}

double white_of(const Image& image) {
  std::vector<double> all;
  for (std::size_t p = 0; p < image.depth_m.size(); ++p) all.push_back(brightest(image, p));
  const auto rank = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(all.size() - 1) + 0.5);
  std::nth_element(all.begin(), all.begin() + rank, all.end());
  return all[static_cast<std::size_t>(rank)];
}

bool near_a_tree(const Image& image, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(image.width_px);
  const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
  for (int j = std::max(0, y - 1); j <= std::min(image.height_px - 1, y + 1); ++j)
    for (int i = std::max(0, x - 1); i <= std::min(image.width_px - 1, x + 1); ++i)
      if (image.instance_id[static_cast<std::size_t>(j) * width + static_cast<std::size_t>(i)] >= 0)
        return true;
  return false;
}

}  // namespace

Forest detail_tree(const std::string& name) { return detail_stand({name}, 1); }

Forest detail_stand(const std::vector<std::string>& kinds, int side) {
  Forest forest;
  double widest_m = 0;
  for (const std::string& name : kinds) {
    Kind kind = kind_named(name);
    widest_m = std::max(widest_m, 2 * measure(kind.prototype).crown_radius_m);
    forest.materials.push_back(std::move(kind.material));
    forest.prototypes.push_back(std::move(kind.prototype));
  }
  for (int i = 0; i < side * side; ++i) {
    RandomStream random(5, static_cast<std::uint64_t>(i), RandomPurpose::kTestScene);
    Instance at;
    at.prototype = PrototypeId{static_cast<std::uint32_t>(i) % static_cast<std::uint32_t>(kinds.size())};
    if (side > 1) {
      at.position_m =
          widest_m * Vec3(i % side + random.uniform(-0.3, 0.3), i / side + random.uniform(-0.3, 0.3), 0);
      at.yaw_rad = static_cast<float>(random.uniform(0, 2 * kPi));
      at.scale = static_cast<float>(random.uniform(0.85, 1.05));
    }
    forest.instances.push_back(at);
  }
  return forest;
}

Illumination detail_light() {
  Illumination light;
  light.to_sun = glm::normalize(Vec3(0.5, -0.4, 0.76));
  light.sun_half_angle_rad = 0.00463;
  light.bands = {{400.0, 100.0}};
  return light;
}

Camera detail_view(const Forest& forest, double pixel_m, int samples) {
  const Box box = forest_bounds(forest);
  const Vec3 to_viewer = glm::normalize(Vec3(0.6, -1, 0.4));
  const double reach_m = glm::length(box.size());
  Camera camera;
  camera.kind = CameraKind::kOrthographic;
  camera.look_at_m = box.centre();
  camera.position_m = box.centre() + reach_m * to_viewer;
  const Vec3 right = glm::normalize(glm::cross(-to_viewer, Vec3(0, 0, 1))),
             up = glm::cross(right, -to_viewer);
  const Vec3 half = 0.5 * box.size();
  const double wide_m = 2.1 * glm::dot(half, glm::abs(right)), high_m = 2.1 * glm::dot(half, glm::abs(up));
  camera.width_px = std::max(3, static_cast<int>(std::ceil(wide_m / pixel_m)));
  camera.height_px = std::max(3, static_cast<int>(std::ceil(high_m / pixel_m)));
  camera.ortho_height_m = camera.height_px * pixel_m;
  camera.samples_per_pixel = samples;
  return camera;
}

OpticsTable detail_optics(const Forest& forest, const std::string& band) {
  return OpticsTable(forest, {.bands = {band}, .soil_albedo = {band == "PAR" ? 0.1 : 0.25}, .overrides = {}});
}

PicturePair path_traced_pair(const Forest& forest, const OpticsTable& optics, Camera camera,
                             const PictureDetail& detail) {
  RenderRequest request{camera, detail_light()};
  request.detail = detail;
  PicturePair pair;
  request.camera.seed = 11;
  pair.a = render_path_traced(forest, optics, request, {});
  request.camera.seed = 12;
  pair.b = render_path_traced(forest, optics, request, {});
  return pair;
}

DetailError detail_error(const PicturePair& shown, const PicturePair& truth) {
  DetailError e;
  double squares = 0;
  for (std::size_t p = 0; p < truth.a.depth_m.size(); ++p) {
    if (!near_a_tree(truth.a, p)) continue;
    ++e.pixels;
    const double a = mean_of(shown.a, p), b = mean_of(shown.b, p), c = mean_of(truth.a, p),
                 d = mean_of(truth.b, p);
    const double off = 0.5 * (a + b - c - d);
    squares += off * off - 0.25 * ((a - b) * (a - b) + (c - d) * (c - d));
    e.bias += off;
  }
  const double white = white_of(truth.a), n = static_cast<double>(std::max<std::size_t>(1, e.pixels));
  e.rms = std::sqrt(std::max(0.0, squares / n)) / white;
  e.bias /= n * white;
  return e;
}

double ray_cost_ns(const PictureScene& scene, const Camera& camera, int samples) {
  const CameraRays rays(camera);
  const Vec3 to_sun = detail_light().to_sun;
  std::size_t sunlit = 0;
  const auto pass = [&](int count) {
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x) {
        RandomStream random(3, static_cast<std::uint64_t>(y * camera.width_px + x),
                            RandomPurpose::kTestScene);
        for (int k = 0; k < count; ++k) {
          const double right = x + random.uniform(), down = y + random.uniform();
          const auto ray = rays.through(right, down);
          const RayStart from{.cast = static_cast<std::uint8_t>(static_cast<std::size_t>(k) % scene.casts())};
          const RayHit hit = scene.closest_hit(ray->origin_m, ray->direction, from);
          if (hit.kind == HitKind::kSky) continue;
          const bool this_side = glm::dot(hit.normal, to_sun) > 0;
          sunlit += !scene.occluded(hit.on_original_m, to_sun, start_from(hit, this_side));
        }
      }
  };
  pass(1);  // fills the caches
  const double began = cpu_seconds();
  pass(samples);
  const double n = static_cast<double>(camera.width_px) * camera.height_px * samples;
  return sunlit > 0 ? (cpu_seconds() - began) / n * 1e9 : 0;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace sunfleck::test
