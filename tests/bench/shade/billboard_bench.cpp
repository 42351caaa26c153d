// Billboard clouds beside [Garcia07] Tables 1 and 2: memory, cover and light against the leaves they stand
// for, and time per ray. Leaves only, no wood; CPU of one thread. Our rays try every plane, as a viewer that
// draws rectangles does; with a tree over the planes the sheet measured 2 to 15 times the time of leaves.
//   shade_billboards [species ...]
#include <cmath>
#include <cstdio>

#include "lighting/bench/stopwatch.h"
#include "lighting/render/image_difference.h"
#include "lighting/shade/billboard_query.h"
#include "lighting/trace/ray_scene.h"
#include "sim/base/parallel.h"
#include "sim/base/random.h"
#include "sim/forest/generated_scenes.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

const Vec3 kSun = glm::normalize(Vec3(0.3, -0.4, 1.0));

struct Tree {
  std::string name;
  Forest forest;
  Box box;
  Vec3 middle{0};
  double reach_m = 1, leaf_side_m = 0.1;

  Tree(std::string called, Forest made) : name(std::move(called)), forest(std::move(made)) {
    Prototype& p = forest.prototypes[0];
    p.wood.clear(), p.wood_mesh.clear();
    box = prototype_bounds(p);
    middle = 0.5 * (box.lo + box.hi);
    reach_m = 0.55 * glm::length(box.size());
    leaf_side_m = std::sqrt(leaf_area_m2(p) / static_cast<double>(p.foliage.size()));
  }
  const std::vector<FoliageElement>& leaves() const { return forest.prototypes[0].foliage; }
};

Tree grown(const std::string& latin, double dbh_cm) {
  const Species species = SpeciesLibrary::load(SUNFLECK_SOURCE_DIR "/configs/species").find(latin, "bench");
  Forest forest;
  forest.materials = {species.material};
  forest.prototypes.push_back(grow_prototype(species, expected_size(species, dbh_cm), 1, 1.0, {}));
  forest.instances.push_back({});
  return Tree(latin, std::move(forest));
}

// A window of the picture seen from direction v: rays from outside, through (a, b) in [-1, 1].
struct View {
  const Tree& tree;
  Vec3 v;
  double across_m = 0, up_m = 0;  // half sizes of the window; 0: of the tree's box as seen
  Basis basis = basis_around(v);
  Vec3 origin(double a, double b) const {
    const Box& box = tree.box;
    const auto half = [&](const Vec3& axis) { return 0.5 * glm::dot(glm::abs(axis), box.size()); };
    const double x = across_m > 0 ? across_m : half(basis.tangent),
                 y = up_m > 0 ? up_m : half(basis.bitangent);
    return tree.middle + a * x * basis.tangent + b * y * basis.bitangent + 3.0 * tree.reach_m * v;
  }
};

struct Cover {
  double mean = 0, worst = 0;
};
Cover cover_of(const Tree& tree, const RayScene& scene, const BillboardCloud& cloud) {
  Cover cover;
  constexpr int side = 112;
  for (int k = 0; k < 27; ++k) {
    if (k == 13) continue;
    const View view{tree, glm::normalize(Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1))};
    int leaves = 0, boards = 0;
    for (int i = 0; i < side * side; ++i) {
      const Vec3 from = view.origin((i % side + 0.5) / side * 2 - 1, (i / side + 0.5) / side * 2 - 1);
      leaves += scene.occluded(from, -view.v);
      boards += closest_billboard(cloud, from, -view.v, 0).has_value();
    }
    const double error = std::abs(static_cast<double>(boards) / leaves - 1);
    cover.mean += error / 26;
    cover.worst = std::max(cover.worst, error);
  }
  return cover;
}

double lambert(const Tree& tree, std::uint32_t leaf) {
  return 0.45 * std::abs(glm::dot(element_normal(tree.leaves()[leaf]), kSun));
}

double leaf_light(const Tree& tree, const RayScene& scene, const Vec3& from, const Vec3& d) {
  const RayHit hit = scene.closest_hit(from, d);
  if (hit.kind != HitKind::kFoliage) return 0.5;
  const bool front = glm::dot(element_normal(tree.leaves()[hit.local]), kSun) > 0;
  return scene.occluded(hit.position_m, kSun, 0, {HitKind::kFoliage, front, 0, hit.local})
             ? 0
             : lambert(tree, hit.local);
}

double board_light(const Tree& tree, const BillboardCloud& cloud, const Vec3& from, const Vec3& d) {
  const auto hit = closest_billboard(cloud, from, d, 0);
  if (!hit) return 0.5;
  return closest_billboard(cloud, from + hit->distance_m * d, kSun, 1e-9, {}, {hit->plane, hit->leaf})
             ? 0
             : lambert(tree, hit->leaf);
}

template <class Light>
std::vector<double> picture(const View& view, int side, int samples, std::uint64_t seed, const Light& light) {
  std::vector<double> pixel(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (std::size_t i = 0; i < pixel.size(); ++i) {
    RandomStream random(seed, i, RandomPurpose::kTestScene);
    for (int k = 0; k < samples; ++k) {
      const double x = static_cast<double>(i % static_cast<std::size_t>(side)) + random.uniform();
      const double y = static_cast<double>(i / static_cast<std::size_t>(side)) + random.uniform();
      pixel[i] += light(view.origin(2 * x / side - 1, 2 * y / side - 1), -view.v) / samples;
    }
  }
  return pixel;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

struct Light {
  int side = 0;
  double corrected = 0, ssim = 0, leaf_ns = 0, board_ns = 0;
};
// Leaves of `leaf_px` pixels.
Light light_of(const Tree& tree, const RayScene& scene, const BillboardCloud& cloud, double leaf_px) {
  Light out;  // of a window of at most 64 pixels around the middle of the crown
  out.side = std::clamp(static_cast<int>(2 * tree.reach_m / tree.leaf_side_m * leaf_px), 11, 64);
  const double half_m = 0.5 * out.side * tree.leaf_side_m / leaf_px;
  const View view{tree, glm::normalize(Vec3(1, 0.4, 0.3)), half_m, half_m};
  const auto leaves = [&](const Vec3& o, const Vec3& d) { return leaf_light(tree, scene, o, d); };
  const auto boards = [&](const Vec3& o, const Vec3& d) { return board_light(tree, cloud, o, d); };
  const int samples = std::max(4, 60000 / (out.side * out.side));
  const Stopwatch first;
  const auto a = picture(view, out.side, samples, 1, leaves), b = picture(view, out.side, samples, 2, leaves);
  const double rays = 2.0 * samples * out.side * out.side;
  out.leaf_ns = 1e9 * first.cpu_s() / rays;
  const Stopwatch second;
  const auto c = picture(view, out.side, samples, 3, boards), d = picture(view, out.side, samples, 4, boards);
  out.board_ns = 1e9 * second.cpu_s() / rays;
  std::vector<double> truth = a, cards = c;
  for (std::size_t i = 0; i < a.size(); ++i) truth[i] = 0.5 * (a[i] + b[i]), cards[i] = 0.5 * (c[i] + d[i]);
  const double raw = rms(truth, cards), noise2 = 0.25 * (std::pow(rms(a, b), 2) + std::pow(rms(c, d), 2));
  out.corrected = std::sqrt(std::max(0.0, raw * raw - noise2));
  out.ssim = structural_similarity(truth, cards, out.side, out.side);
  return out;
}

void published() {
  std::printf(
      "[Garcia07] Table 1: leaves, billboards, bytes (compressed 1:6)    Table 2: frames per second, "
      "polygons / "
      "billboards\n"
      "  Chestnut 11291 278 3486762; Oak 23660 194 3119734; Cork 20144 121 1462870;      1 tree 180 / 80; "
      "50: 47 "
      "/ 46;\n"
      "  Horse chestnut 9366 202 3376653; Shrub 2388 198 1349091; Maple 3662 175         100: 15 / 39; 1000: "
      "5 / "
      "28;\n"
      "  1381600; Alder 1049 228 1332837. Chestnut: 3.7 MB, polygons 23 MB,              10000: - / 20\n"
      "  plain textures of the same detail 246 MB\n");
}

void row(const Tree& tree, int planes) {
  const Stopwatch watch;
  BillboardOptions options;
  options.clusters.planes = planes;
  const BillboardCloud cloud = build_billboard_cloud(tree.forest.prototypes[0], options);
  const double build_s = watch.cpu_s();
  const RayScene scene(tree.forest, {.ground = false});
  const BillboardMemory memory = billboard_memory(cloud);
  double area = 0;
  for (const Billboard& b : cloud.plane) area += b.width_m * b.height_m;
  // Plain: RGBA of 64 texels per leaf (8 by 8) over all planes. Polygons: two triangles per leaf, 4 corners
  // of 32 bytes (position, normal, place) and 6 numbers.
  const double plain_mb = 4e-6 * area * 64 / (tree.leaf_side_m * tree.leaf_side_m);
  const double polygons_mb = (4 * 32 + 6 * 4) * 1e-6 * static_cast<double>(tree.leaves().size());
  const Cover cover = cover_of(tree, scene, cloud);
  std::printf(
      "%-22s %6zu leaves %4zu planes  %9zu bytes (lists %zu)  plain %.0f MB, polygons %.1f MB  built %.1f "
      "s\n",
      tree.name.c_str(), tree.leaves().size(), cloud.plane.size(), memory.total(), memory.lists, plain_mb,
      polygons_mb, build_s);
  std::printf("    cover |error| mean %.2f %%, worst of 26 views %.2f %%\n", 100 * cover.mean,
              100 * cover.worst);
  for (const double leaf_px : {0.25, 0.5, 1.0}) {
    const Light light = light_of(tree, scene, cloud, leaf_px);
    std::printf(
        "    leaf %.2f px (%d px): radiance RMS %.4f, SSIM %.3f; ns per sample with shadow: leaves %.0f, "
        "boards %.0f\n",
        leaf_px, light.side, light.corrected, light.ssim, light.leaf_ns, light.board_ns);
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  using namespace sunfleck;
  published();
  with_threads(1, [&] {
    if (argc > 1) {
      for (int i = 1; i < argc; ++i) row(grown(argv[i], 20), 260);
      return;
    }
    const Tree ball("ball", generated_crown({CrownKind::kSphere, 10000, 1, 4, 3}));
    for (const int planes : {60, 130, 260}) row(ball, planes);
    row(Tree("clumped", generated_crown({CrownKind::kClumped, 10000, 1, 4, 3})), 260);
    for (const char* latin : {"Fagus sylvatica", "Betula pendula"}) row(grown(latin, 15), 260);
  });
}
