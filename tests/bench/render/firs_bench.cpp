// The 80 firs of [Meyer00] section 7: needles one by one against boughs with a closed form, in one run. Says
// for each number of samples per pixel the error against a picture of 1024 samples of explicit needles (in
// two halves, whose difference gives the noise that is taken off), thread CPU time, and how much longer
// explicit needles take for the same error. Also one fir at 8 to 256 pixels.
//   lighting_render_firs [quick|single|forest|all]
#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>

#include "lighting/trace/bough_scene.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

constexpr double kBackground = 0.5;
constexpr int kBoughs = 300, kNeedlesEach = 96;
const Vec3 kToSun = glm::normalize(Vec3(-0.5, -0.6, 0.7));

double thread_s() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// The paper's bough, centimetres to metres: needles 4.25 long, 0.05 thick, 22.5 degrees off the branch, one
// whorl of 12 every 0.9: eight whorls.
FoliageTemplate fir_needles() {
  FoliageTemplate f;
  f.kind = FoliageKind::kShoot;
  f.shoot_length_m = 0.111;
  f.shoot_radius_m = 0.01626 / 0.92;
  f.needle_length_m = 0.0425;
  f.needle_width_m = 0.001;
  f.needles_per_m = kNeedlesEach / f.shoot_length_m;
  return f;
}

// A cone of boughs one metre high: more where it is wide, from a quarter of the radius outwards, rising.
Prototype fir(std::uint64_t seed) {
  const FoliageTemplate f = fir_needles();
  Prototype tree;
  tree.materials = {"fir"};
  RandomStream random(seed, 0, RandomPurpose::kTestScene);
  for (int i = 0; i < kBoughs; ++i) {
    const double down = std::sqrt((i + random.uniform()) / kBoughs), radius = 0.04 + 0.26 * down;
    const double rho = radius * std::sqrt(random.uniform(0.06, 1)),
                 turn = 2.399963 * i + random.uniform(-0.3, 0.3);
    const double lean = turn + random.uniform(-0.5, 0.5), rise = random.uniform(0.05, 0.5) + 0.8 * (1 - down);
    const Vec3 axis = glm::normalize(Vec3(std::cos(lean), std::sin(lean), rise));
    const Vec3 centre(rho * std::cos(turn), rho * std::sin(turn), 0.05 + 0.9 * (1 - down));
    FoliageElement e;
    e.shape = ElementShape::kShoot;
    e.centre_m = Vec3f(centre);
    e.half_u_m = Vec3f(0.5 * f.shoot_length_m * axis);
    e.half_v_m = Vec3f(f.shoot_radius_m * basis_around(axis).tangent);
    e.area_m2 = static_cast<float>(f.shoot_area_m2());
    tree.foliage.push_back(e);
  }
  return tree;
}

struct Line {
  Vec3 origin, direction;
};
struct View {
  int width, height;
  int step = 1;  // the reference and errors are of every step-th pixel in x and y
  std::function<Line(double x, double y)> ray;
  BoughScene::Viewer viewer;
};

using Shade = std::function<double(const Line&)>;
using Picture = std::vector<float>;

// Mean over `samples` points of a pixel, on a lattice that fills it evenly, shifted in each pixel by its own.
double pixel(const View& view, const Shade& shade, int x, int y, int samples, std::uint64_t seed) {
  const std::uint64_t lot =
      mix_seed(seed, static_cast<std::uint64_t>(y) * 65536 + static_cast<std::uint64_t>(x));
  const double sx = static_cast<double>(lot >> 32) * 0x1p-32,
               sy = static_cast<double>(lot & 0xFFFFFFFFu) * 0x1p-32;
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    double whole;
    const double u = std::modf(sx + i * 0.7548776662466927, &whole),
                 v = std::modf(sy + i * 0.5698402909980532, &whole);
    sum += shade(view.ray(x + u, y + v));
  }
  return sum / samples;
}

Picture draw(const View& view, const Shade& shade, int samples, std::uint64_t seed) {
  Picture picture;
  for (int y = 0; y < view.height; y += view.step)
    for (int x = 0; x < view.width; x += view.step)
      picture.push_back(static_cast<float>(pixel(view, shade, x, y, samples, seed)));
  return picture;
}

Picture draw_parallel(const View& view, const Shade& shade, int samples, std::uint64_t seed) {
  const int columns = (view.width + view.step - 1) / view.step,
            rows = (view.height + view.step - 1) / view.step;
  Picture picture(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_chunk(picture.size(), 64, {}, "", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int x = static_cast<int>(i) % columns * view.step, y = static_cast<int>(i) / columns * view.step;
      picture[i] = static_cast<float>(pixel(view, shade, x, y, samples, seed));
    }
  });
  return picture;
}

double mean_square(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(static_cast<double>(a[i]) - b[i], 2);
  return sum / static_cast<double>(a.size());
}

double mean(const Picture& a) {
  double sum = 0;
  for (const float x : a) sum += static_cast<double>(x);
  return sum / static_cast<double>(a.size());
}

struct Reference {
  Picture picture;
  double noise2 = 0;
};
Reference two_halves(const View& view, const Shade& shade, int samples) {
  const Picture a = draw_parallel(view, shade, samples / 2, 101),
                b = draw_parallel(view, shade, samples / 2, 202);
  Reference r{a, mean_square(a, b) / 4};
  for (std::size_t i = 0; i < a.size(); ++i) r.picture[i] = 0.5f * (a[i] + b[i]);
  return r;
}

struct Run {
  int samples;
  double rmse, cpu_s, bias;
};

// Small pictures are drawn several times with other samples: mean square error and mean time. `shade` makes
// the shading anew for each, so that what it keeps is paid by every picture.
Run measure(const View& view, const std::function<Shade()>& shading, const Reference& truth, int samples) {
  const double rays = static_cast<double>(truth.picture.size()) * samples;
  const int pictures = std::clamp(static_cast<int>(60000 / rays), 1, 100);
  draw(view, shading(), 1, 6);  // caches warm for all alike
  Run run{samples, 0, 0, 0};
  for (int i = 0; i < pictures; ++i) {
    const double began = thread_s();
    const Picture p = draw(view, shading(), samples, 7 + static_cast<std::uint64_t>(i));
    run.cpu_s += (thread_s() - began) / pictures;
    run.rmse += mean_square(p, truth.picture) / pictures;
    run.bias += (mean(p) - mean(truth.picture)) / pictures;
  }
  run.rmse = std::sqrt(std::max(0.0, run.rmse - truth.noise2));
  return run;
}

// Samples that explicit needles need for an error: on the straight line (in logarithms) through the two
// measured ones around it, or through the nearest by 1 / sqrt.
double explicit_seconds(const std::vector<Run>& runs, double rmse) {
  for (std::size_t i = 0; i + 1 < runs.size(); ++i)
    if (rmse <= runs[i].rmse && rmse >= runs[i + 1].rmse) {
      const double share = std::log(runs[i].rmse / rmse) / std::log(runs[i].rmse / runs[i + 1].rmse);
      return runs[i].cpu_s * std::pow(runs[i + 1].cpu_s / runs[i].cpu_s, share);
    }
  const Run& near = rmse > runs.front().rmse ? runs.front() : runs.back();
  return near.cpu_s * std::pow(near.rmse / rmse, 2);
}

struct Firs {
  Forest forest;
  std::vector<NeedleKind> kinds{{"fir", fir_needles()}};
  RayScene needles;
  BoughScene boughs;
  explicit Firs(Forest f)
      : forest(std::move(f)),
        needles(forest, {.ground = false, .shoots = ShootForm::kNeedles, .needles = kinds}),
        boughs(forest, kinds) {}

  double explicit_at(const Line& l) const {
    const RayHit hit = needles.closest_hit(l.origin, l.direction);
    if (hit.kind == HitKind::kSky) return kBackground;
    const double cosine = glm::dot(hit.normal, kToSun);
    return cosine > 0 && !needles.occluded(hit.on_original_m, kToSun, 0, start_from(hit, true)) ? cosine : 0;
  }
};

void print_run(const char* name, const Run& r, std::size_t pixels) {
  std::printf("  %-9s %3d spp  rmse %.4f  bias %+.4f  %9.5f s  %5.0f ns/sample", name, r.samples, r.rmse,
              r.bias, r.cpu_s, 1e9 * r.cpu_s / (static_cast<double>(pixels) * r.samples));
}

void compare(const char* name, const Firs& firs, const View& view, int truth_samples,
             const std::vector<int>& stations, double bough_px) {
  const Shade each = [&](const Line& l) { return firs.explicit_at(l); };
  const Reference truth = two_halves(view, each, truth_samples);
  const std::size_t pixels = truth.picture.size();
  std::printf("%s: %d x %d, boughs %.2f px, noise of the truth %.4f, mean %.4f\n", name, view.width,
              view.height, bough_px, std::sqrt(truth.noise2), mean(truth.picture));
  std::vector<Run> runs;
  for (const int spp : {1, 4, 16, 64}) {
    runs.push_back(measure(
        view, [&] { return each; }, truth, spp));
    print_run("explicit", runs.back(), pixels);
    std::printf("\n");
  }
  for (const int n : stations)
    for (const int spp : {1, 2, 4, 16, 64}) {
      const auto boughs = [&]() -> Shade {
        const auto lit = std::make_shared<BoughScene::Lit>(firs.boughs, view.viewer, kToSun, n);
        return [&firs, lit](const Line& l) {
          const BoughScene::Seen s = firs.boughs.seen(l.origin, l.direction, *lit);
          return static_cast<double>(s.reflected) + static_cast<double>(s.through) * kBackground;
        };
      };
      const Run r = measure(view, boughs, truth, spp);
      print_run(("boughs/" + std::to_string(n)).c_str(), r, pixels);
      std::printf("  explicit/boughs: same error %5.2f, at 64 spp %6.1f\n",
                  explicit_seconds(runs, r.rmse) / r.cpu_s, runs.back().cpu_s / r.cpu_s);
    }
  std::fflush(stdout);
}

void single(int largest) {
  Forest forest;
  forest.materials = {{"fir", {}}};
  forest.prototypes = {fir(1)};
  forest.instances.emplace_back();
  const Firs firs(std::move(forest));
  for (int px = 8; px <= largest; px *= 2) {
    View view;
    view.height = px, view.width = std::max(4, px * 3 / 4);
    const double metre_px = px / 1.04;
    view.ray = [=](double x, double y) {
      return Line{{(x - 0.5 * view.width) / metre_px, -5.0, 1.02 - y / metre_px}, {0, 1, 0}};
    };
    view.viewer = {{0, -5, 0.5}, true, {0, 1, 0}};
    compare(("fir of " + std::to_string(px) + " px").c_str(), firs, view, 1024, {1}, 0.033 * metre_px);
  }
}

// Trees from `nearest_px` to half of that, 127 to 64 in the paper.
void eighty(double nearest_px, int step) {
  constexpr int kRows = 8, kColumns = 10;
  const double focal_px = 10 * nearest_px;
  const int width = static_cast<int>(0.97 * focal_px), height = static_cast<int>(0.167 * focal_px);
  const double left_px = 0.5 * width, above_px = 0.044 * focal_px;
  Forest forest;
  forest.materials = {{"fir", {}}};
  forest.prototypes = {fir(1)};
  RandomStream random(2, 0, RandomPurpose::kTestScene);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const double away = 10.0 + 10.0 * r / (kRows - 1);
      Instance at;
      at.position_m = {((c + 0.5 + random.uniform(-0.3, 0.3)) / kColumns - 0.5) * 0.97 * away, away, 0};
      at.yaw_rad = static_cast<float>(random.uniform(0, 2 * kPi));
      forest.instances.push_back(at);
    }
  const Firs firs(std::move(forest));
  View view;
  view.width = width, view.height = height, view.step = step;
  const Vec3 eye(0, 0, 2);
  view.ray = [=](double x, double y) {
    return Line{eye, glm::normalize(Vec3(x - left_px, focal_px, -(y + above_px)))};
  };
  view.viewer = {eye, false, {0, 1, 0}};
  std::printf("80 firs: explicit needles %.1f MB, boughs %.2f MB\n",
              1e-6 * static_cast<double>(firs.needles.memory_bytes()),
              1e-6 * static_cast<double>(firs.boughs.memory_bytes()));
  compare(("80 firs of " + std::to_string(static_cast<int>(nearest_px)) + " px to half of it").c_str(), firs,
          view, 1024, {1, 3}, 0.033 * focal_px / 15);
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "all";
  if (what == "quick") sunfleck::single(32);
  if (what == "single" || what == "all") sunfleck::single(256);
  if (what == "forest" || what == "all") {
    sunfleck::eighty(127, 2);
    sunfleck::eighty(42, 1);
    sunfleck::eighty(14, 1);
  }
  return 0;
}
