// Sunflecks of the tile (lighting/render/leaf_flecks.h) against shadow rays in the setting of a picture: what
// design sheet 7.7 asks for, on crowns and L-system trees, and whole pictures of growing size.
//   lighting_render_leaf_sun [scenes]    names of lighting/bench/bench_scenes.h, by commas
#include <cmath>
#include <cstdio>

#include "lighting/bench/bench_scenes.h"
#include "lighting/bench/stopwatch.h"
#include "lighting/render/image_difference.h"
#include "lighting/render/leaf_flecks.h"
#include "lighting/trace/reference.h"
#include "lighting/transport/grid_estimator.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr std::array<double, 3> kSeparations{0.25, 0.5, 1.0};
constexpr std::size_t kPointsPerLeaf = 12;  // two pairs for each separation

struct Setting {
  Forest forest;
  ForestIndex index;
  OpticsTable optics;
  Illumination light;
  PictureScene scene;

  explicit Setting(Forest made)
      : forest(std::move(made)),
        index(forest),
        optics(forest, {.bands = {"PAR"}, .soil_albedo = {0.1}, .overrides = {}}),
        light(sun_and_sky()),
        scene(forest, plain_look(), {}) {}

  static Illumination sun_and_sky() {
    Illumination light;
    light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(150), radians_from_degrees(35));
    light.sun_half_angle_rad = radians_from_degrees(0.265);
    light.bands = {{400 / light.to_sun.z, 100}};
    return light;
  }
};

struct Point {
  RayHit hit;
  std::size_t element = 0;
  bool near_trunk = false;
};

// Pairs on leaves at the three separations (in sides of the leaf, along and across it).
std::vector<Point> points_of(const Setting& s, std::size_t leaves) {
  std::vector<Point> points;
  const double near_m = 0.1 * prototype_reach_m(s.forest.prototypes[0]);
  for (std::size_t i = 0; i < leaves; ++i) {
    const std::size_t element = i * s.index.element_count() / leaves;
    const auto place = s.index.place(element);
    const Instance& at = s.forest.instances[place.instance];
    const FoliageElement& e = s.forest.prototypes[at.prototype.value].foliage[place.local];
    RandomStream random(7, element, RandomPurpose::kTestScene);
    for (const double separation : kSeparations)
      for (int pair = 0; pair < 2; ++pair) {
        double a = 0, b = 0, c = 2, d = 2;
        while (std::abs(c) > 1 || std::abs(d) > 1) {
          a = random.uniform(-1, 1), b = random.uniform(-1, 1);
          const double turn = random.uniform(0, 2 * kPi);
          c = a + 2 * separation * std::cos(turn), d = b + 2 * separation * std::sin(turn);
        }
        for (const Vec2& ab : {Vec2(a, b), Vec2(c, d)}) {
          Point p;
          p.element = element;
          p.hit.kind = HitKind::kFoliage;
          p.hit.instance = place.instance, p.hit.local = place.local;
          const Vec3 local = Vec3(e.centre_m) + ab.x * Vec3(e.half_u_m) + ab.y * Vec3(e.half_v_m);
          p.hit.position_m = p.hit.on_original_m = world_from_tree(at, local);
          p.hit.normal = e.shape == ElementShape::kShoot ? s.light.to_sun
                                                         : world_direction_from_tree(at, element_normal(e));
          p.hit.front = glm::dot(p.hit.normal, s.light.to_sun) > 0;
          p.near_trunk = std::hypot(local.x, local.y) < near_m;
          points.push_back(p);
        }
      }
  }
  return points;
}

struct Figures {
  double mean = 0, near_trunk = 0, variance = 0;
  std::array<double, 3> correlation{};
};

Figures figures_of(const std::vector<Point>& points, const std::vector<char>& lit) {
  Figures f;
  double near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    f.mean += lit[i] / static_cast<double>(points.size());
    if (points[i].near_trunk) f.near_trunk += lit[i], near += 1;
  }
  f.near_trunk /= std::max(near, 1.0);
  std::array<double, 3> together{};
  for (std::size_t i = 0; i < points.size(); i += 2)
    together[i % kPointsPerLeaf / 4] += (lit[i] - f.mean) * (lit[i + 1] - f.mean);
  for (std::size_t k = 0; k < 3; ++k)
    f.correlation[k] = together[k] / (static_cast<double>(points.size()) / 6 * f.mean * (1 - f.mean));
  for (std::size_t i = 0; i < points.size(); i += kPointsPerLeaf) {
    double mean = 0;
    for (std::size_t j = 0; j < kPointsPerLeaf; ++j) mean += lit[i + j] / static_cast<double>(kPointsPerLeaf);
    f.variance += (mean - f.mean) * (mean - f.mean) * kPointsPerLeaf / static_cast<double>(points.size());
  }
  return f;
}

void print(const char* what, const Figures& f, double ns, const Figures& truth) {
  std::printf(
      "  %-22s mean %.4f (%+.4f)  near trunk %+.4f  leaf variance %+.1f %%  correlation %.3f %.3f %.3f "
      "(%+.3f %+.3f %+.3f)  %.1f ns\n",
      what, f.mean, f.mean - truth.mean, f.near_trunk - truth.near_trunk,
      100 * (f.variance / truth.variance - 1), f.correlation[0], f.correlation[1], f.correlation[2],
      f.correlation[0] - truth.correlation[0], f.correlation[1] - truth.correlation[1],
      f.correlation[2] - truth.correlation[2], ns);
}

template <class Lit>
Figures measure(const std::vector<Point>& points, double& ns, const Lit& lit) {
  std::vector<char> answer(points.size());
  const Stopwatch watch;
  for (std::size_t i = 0; i < points.size(); ++i) answer[i] = lit(points[i]) ? 1 : 0;
  ns = 1e9 * watch.cpu_s() / static_cast<double>(points.size());
  return figures_of(points, answer);
}

void points_table(const Setting& s, const LightMap& traced_map, const LightMap& grid_map) {
  const std::vector<Point> points = points_of(s, 20000);
  double ray_ns = 0, ns = 0;
  const Figures truth = measure(points, ray_ns, [&](const Point& p) {
    return !s.scene.occluded(p.hit.on_original_m, s.light.to_sun,
                             {HitKind::kFoliage, p.hit.front, p.hit.instance, p.hit.local});
  });
  print("shadow ray", truth, ray_ns, truth);
  for (const LightMap* map : {&traced_map, &grid_map}) {
    const Stopwatch watch;
    const LeafFlecks flecks(s.forest, s.scene, *map, s.light.to_sun, {});
    const double made_s = watch.cpu_s();
    double first_ns = 0;
    const auto lit = [&](const Point& p) { return flecks.lit(p.hit, p.element); };
    measure(points, first_ns, lit);
    const Figures f = measure(points, ns, lit);
    print(map == &traced_map ? "tile, map of leaves" : "tile, smooth map", f, ns, truth);
    std::printf(
        "  %-22s %.0f times cheaper than a ray; tiles made in %.3f s; first time, 12 places a leaf: %.0f ns "
        "each\n",
        "", ray_ns / ns, made_s, first_ns);
  }
}

Image picture(const Setting& s, const LightMap& map, LeafSun sun, int side_px, std::uint64_t seed,
              double& s_cpu) {
  Camera camera;
  camera.kind = CameraKind::kOrthographic;
  const Box& box = s.scene.box();
  const Vec3 middle = 0.5 * (box.lo + box.hi);
  camera.ortho_height_m = 1.1 * std::max({box.size().x, box.size().y, box.size().z});
  camera.position_m = middle + 100.0 * glm::normalize(Vec3(0.6, -1, 0.5));
  camera.look_at_m = middle;
  camera.width_px = camera.height_px = side_px;
  camera.samples_per_pixel = 64;
  camera.seed = seed;
  const Stopwatch watch;
  Image image = render(s.forest, s.optics, map, {camera, s.light, plain_look(), {}, sun}, {});
  s_cpu = watch.cpu_s();
  return image;
}

void pictures_table(const Setting& s, const LightMap& map) {
  for (const int side : {32, 64, 128, 256}) {
    double traced_s = 0, again_s = 0;
    const Image traced = picture(s, map, LeafSun::kTraced, side, 1, traced_s);
    const Image again = picture(s, map, LeafSun::kTraced, side, 2, again_s);
    const ImageDifference noise = image_difference(again, traced);
    std::printf("  %3d px: traced %.3f s; another seed: absolute %.2f %%, SSIM %.4f, FLIP %.4f\n", side,
                traced_s, 100 * noise.mean_absolute, noise.ssim, noise.flip);
    for (const LeafSun sun : {LeafSun::kTile, LeafSun::kStored}) {
      double cpu = 0;
      const Image image = picture(s, map, sun, side, 2, cpu);
      const ImageDifference d = image_difference(image, traced);
      std::printf(
          "          %s %.3f s (%.2f times less): mean %+.2f %%, absolute %.2f %%, SSIM %.4f, FLIP %.4f\n",
          sun == LeafSun::kTile ? "tile  " : "stored", cpu, traced_s / cpu, 100 * d.bias,
          100 * d.mean_absolute, d.ssim, d.flip);
    }
  }
}

void run(const BenchScene& made) {
  const Setting s(made.make({}));
  const LightMap traced =
      reference_light_map(s.forest, s.optics, s.light, {.rays_per_face = 8, .sun_rays_per_element = 64}, {});
  LightMap of_leaves = traced;
  of_leaves.provenance.method = "reference";
  LightMap grid = grid_light_map(s.forest, s.optics, s.light, GridOptions{}, {});
  grid.provenance.method = "grid";
  std::printf("%s (%zu elements)\n", made.name.c_str(), s.index.element_count());
  points_table(s, of_leaves, grid);
  pictures_table(s, of_leaves);
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  using namespace sunfleck;
  const auto scenes = bench_scenes(1, SUNFLECK_SOURCE_DIR "/configs/species");
  with_threads(1, [&] {
    for (const BenchScene& scene : choose_scenes(scenes, argc > 1 ? argv[1] : "sphere,clumped,beech,spruce"))
      run(scene);
  });
}
