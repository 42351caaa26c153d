// Pruned leaves (one pruning, and four that samples take in turn) and billboards against all leaves, picture
// by picture: time per sample (primary ray and shadow ray), error of cover, RMS error of radiance with the
// sampling noise taken out, bias. One tree of 100,000 leaves (crown LAI 5) seen from the side at 8 to 64
// pixels, leaf reflectance .45, background .5, one sun. CPU time of one thread; ratios within a run are what
// counts. Prints one line per picture and representation.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <vector>

#include "lighting/shade/billboard_query.h"
#include "lighting/shade/prune.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.3, -0.4, 1.0)), kMiddle(0, 0, 1.5);
const Vec3 kViewer = glm::normalize(Vec3(1, 0.4, 0.3));

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

using Shade = std::function<double(const Vec3& origin, const Vec3& direction, bool& hit)>;
constexpr int kPrunings = 4;

// Two independent halves, so that their difference tells the noise.
struct Picture {
  std::vector<double> half[2];
  double cover = 0, ns_per_sample = 0;
};

Picture picture_of(int side, int samples, std::uint64_t seed, const Shade& shade) {
  Picture picture;
  const Basis basis = basis_around(kViewer);
  const auto pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  const double begin = cpu_seconds();
  for (std::vector<double>& half : picture.half) half.assign(pixels, 0);
  for (std::size_t i = 0; i < pixels; ++i) {
    RandomStream random(seed, i, RandomPurpose::kTestScene);
    const double x = static_cast<double>(i % static_cast<std::size_t>(side));
    const double y = static_cast<double>(i / static_cast<std::size_t>(side));
    for (int k = 0; k < samples; ++k) {
      const double a = (x + random.uniform()) / side * 2.2 - 1.1,
                   b = (y + random.uniform()) / side * 2.2 - 1.1;
      bool hit = false;
      picture.half[k % 2][i] +=
          2 * shade(kMiddle + a * basis.tangent + b * basis.bitangent + 5.0 * kViewer, -kViewer, hit) /
          samples;
      picture.cover += hit;
    }
  }
  const double count = static_cast<double>(pixels) * samples;
  picture.cover /= count;
  picture.ns_per_sample = (cpu_seconds() - begin) / count * 1e9;
  return picture;
}

struct Errors {
  double rms = 0, bias = 0;
};

// Mean square of the difference of means less both noises (half the halves' mean square difference, halved).
Errors errors_of(const Picture& p, const Picture& truth) {
  Errors e;
  double square = 0;
  const std::size_t n = truth.half[0].size();
  for (std::size_t i = 0; i < n; ++i) {
    const double off = 0.5 * (p.half[0][i] + p.half[1][i] - truth.half[0][i] - truth.half[1][i]);
    const double own = p.half[0][i] - p.half[1][i], other = truth.half[0][i] - truth.half[1][i];
    square += (off * off - 0.25 * (own * own + other * other)) / static_cast<double>(n);
    e.bias += off / static_cast<double>(n);
  }
  e.rms = std::sqrt(std::max(0.0, square));
  return e;
}

Shade leaves_shade(const RayScene& scene, const Prototype& tree) {
  return [&scene, &tree](const Vec3& origin, const Vec3& direction, bool& hit) {
    const RayHit at = scene.closest_hit(origin, direction);
    hit = at.kind == HitKind::kFoliage;
    if (!hit) return 0.5;
    const double cosine = glm::dot(element_normal(tree.foliage[at.local]), kSun);
    const RayStart from{HitKind::kFoliage, cosine > 0, 0, at.local};
    return scene.occluded(at.position_m, kSun, 0, from) ? 0.0 : 0.45 * std::abs(cosine);
  };
}

// Samples look at four prunings in turn.
Forest four_prunings(const Forest& forest, double keep) {
  Forest four = forest;
  four.prototypes.clear();
  for (std::uint64_t c = 0; c < kPrunings; ++c)
    four.prototypes.push_back(prune_prototype(forest.prototypes[0], keep, 7 + c));
  return four;
}

std::vector<std::vector<PrototypeId>> four_casts() {
  std::vector<std::vector<PrototypeId>> casts;
  for (std::uint32_t c = 0; c < kPrunings; ++c) casts.push_back({PrototypeId{c}});
  return casts;
}

Shade turns_shade(const RayScene& scene, const Forest& four) {
  return [&scene, &four, turn = 0u](const Vec3& origin, const Vec3& direction, bool& hit) mutable {
    const auto cast = static_cast<std::uint8_t>(turn++ / 2 % kPrunings);  // halves of a picture see all
    const RayHit at = scene.closest_hit(origin, direction, 0, {.cast = cast});
    hit = at.kind == HitKind::kFoliage;
    if (!hit) return 0.5;
    const double cosine = glm::dot(element_normal(four.prototypes[cast].foliage[at.local]), kSun);
    const RayStart from{HitKind::kFoliage, cosine > 0, 0, at.local, cast};
    return scene.occluded(at.position_m, kSun, 0, from) ? 0.0 : 0.45 * std::abs(cosine);
  };
}

void print(int side, const char* name, double kept, const Picture& p, const Picture& truth) {
  const Errors e = errors_of(p, truth);
  std::printf("%4d px  %-14s f %.4f  %6.0f ns  %5.2fx  cover %+5.1f %%  rms %.4f  bias %+.4f\n",
              static_cast<int>(std::lround(side / 1.1)), name, kept, p.ns_per_sample,
              truth.ns_per_sample / p.ns_per_sample, 100 * (p.cover / truth.cover - 1), e.rms, e.bias);
  std::fflush(stdout);
}

void compare(const Forest& forest, int side, const BillboardCloud& cloud) {
  const Prototype& tree = forest.prototypes[0];
  const double leaf_m = std::sqrt(element_geometric_area(tree.foliage[0])), footprint_m = 2.2 / side;
  const int samples = std::max(32, 400000 / (side * side));
  const RayScene scene(forest, {.ground = false});
  const Picture truth = picture_of(side, 2 * samples, 1, leaves_shade(scene, tree));
  print(side, "all leaves", 1, truth, truth);
  for (const double keep : {1.0 / 4, 1.0 / 16, 1.0 / 64}) {
    if (keep < 0.9 * prune_share(leaf_m, footprint_m) / 4) continue;  // far beyond the rule
    Forest pruned = forest;
    pruned.prototypes[0] = prune_prototype(tree, keep, 7);
    const RayScene far(pruned, {.ground = false});
    const bool allowed = keep >= prune_share(leaf_m, footprint_m);
    print(side, allowed ? "pruned" : "(beyond rule)", keep,
          picture_of(side, samples, 2, leaves_shade(far, pruned.prototypes[0])), truth);
    const Forest four = four_prunings(forest, keep);
    const RayScene in_turn(four, {.ground = false, .casts = four_casts()});
    print(side, "four in turn", keep, picture_of(side, samples, 4, turns_shade(in_turn, four)), truth);
  }
  const Shade boards = [&](const Vec3& origin, const Vec3& direction, bool& hit) {
    const auto at = closest_billboard(cloud, origin, direction, 0);
    hit = at.has_value();
    if (!hit) return 0.5;
    const Vec3 point = origin + at->distance_m * direction;
    const double cosine = std::abs(glm::dot(element_normal(tree.foliage[at->leaf]), kSun));
    return closest_billboard(cloud, point, kSun, 1e-9, {}, {at->plane, at->leaf}) ? 0.0 : 0.45 * cosine;
  };
  print(side, "billboards 130", 1, picture_of(side, std::max(8, samples / 8), 3, boards), truth);
}

}  // namespace
}  // namespace sunfleck

int main() {
  using namespace sunfleck;
  const Forest forest = generated_crown({CrownKind::kSphere, 100000, 1, 5, 3});
  const BillboardCloud cloud =
      build_billboard_cloud(forest.prototypes[0], {{130, 15, 20, 60, 1}, 3, true, false});
  const BillboardMemory memory = billboard_memory(cloud);
  std::printf("billboards: %zu planes, %.2f MB\n", cloud.plane.size(),
              static_cast<double>(memory.total()) / 1e6);
  for (const int side : {9, 18, 35, 70}) compare(forest, side, cloud);
}
