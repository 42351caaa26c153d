// Time and memory of a picture among 50,000 trees on 100 ha with all trees loaded and with those it needs:
//   lighting_render_seen make FILE.vdb      a stand of 400 blocks with five own prototypes of 2,000 leaves
//   each lighting_render_seen all FILE.vdb       load_forest, then path-traced lighting_render_seen some
//   FILE.vdb 0.1  read_sketch, load_prototypes, then path-traced to that share of light
// One process each, so that the peak memory is its own.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "lighting/render/seen_trees.h"
#include "sim/base/random.h"
#include "sim/grid/forest_file.h"
#include "sim/grid/read_selection.h"

namespace {

using namespace sunfleck;

constexpr int kColumns = 224, kBlocks = 20, kPerBlock = 5, kLeaves = 2000;
constexpr std::size_t kTrees = 50'000;
constexpr double kSideM = 1000;

Prototype crown(std::uint64_t number) {
  RandomStream random(5, number, RandomPurpose::kTestScene);
  const auto draw = [&](double lo, double hi) { return static_cast<float>(random.uniform(lo, hi)); };
  Prototype tree;
  tree.name = "tree " + std::to_string(number);
  tree.materials = {"leaf"};
  const float height_m = draw(16, 25);
  tree.wood.push_back({{0, 0, 0}, {0, 0, height_m}, 0.15f, 0.03f, 0});
  while (tree.foliage.size() < kLeaves) {
    const Vec3 p(draw(-2, 2), draw(-2, 2), draw(0.4 * height_m, height_m));
    if (p.x * p.x + p.y * p.y > 4) continue;
    const Vec3 normal = glm::normalize(Vec3(random.normal(), random.normal(), random.normal()));
    const Basis axes = basis_around(normal);
    FoliageElement leaf;
    leaf.centre_m = Vec3f(p);
    leaf.half_u_m = Vec3f(0.07 * axes.tangent), leaf.half_v_m = Vec3f(0.07 * axes.bitangent);
    leaf.area_m2 = static_cast<float>(element_geometric_area(leaf));
    tree.foliage.push_back(leaf);
  }
  return tree;
}

Forest stand() {
  Forest forest;
  forest.name = "hundred hectares";
  forest.materials = {{"leaf", {{"PAR", 0.10, 0.05, 0.2}}}};
  for (std::uint64_t p = 0; p < kBlocks * kBlocks * kPerBlock; ++p) forest.prototypes.push_back(crown(p));
  for (std::size_t i = 0; i < kTrees; ++i) {
    RandomStream random(6, i, RandomPurpose::kTestScene);
    Instance tree;
    const double x = (static_cast<double>(i % kColumns) + random.uniform(.15, .85)) * kSideM / kColumns;
    const double y = (static_cast<double>(i / kColumns) + random.uniform(.15, .85)) * kSideM / kColumns;
    const auto block = static_cast<std::uint32_t>(x * kBlocks / kSideM) +
                       kBlocks * static_cast<std::uint32_t>(y * kBlocks / kSideM);
    tree.position_m = {x, y, 0};
    tree.yaw_rad = static_cast<float>(random.uniform(0, 6));
    tree.prototype = PrototypeId{kPerBlock * block + random.below(kPerBlock)};
    tree.tree = TreeId{static_cast<std::uint32_t>(i + 1)};
    forest.instances.push_back(tree);
  }
  return forest;
}

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

double peak_gb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1.024e-6 * static_cast<double>(usage.ru_maxrss);
}

RenderRequest request() {
  RenderRequest r;
  r.camera.position_m = {500.3, 500.2, 2};
  r.camera.look_at_m = {540, 560, 6};
  r.camera.width_px = 300, r.camera.height_px = 200;
  r.camera.samples_per_pixel = 4;
  r.light.to_sun = direction_from_azimuth_zenith(radians_from_degrees(200), radians_from_degrees(40));
  r.light.bands = {BandLight{400, 90}};
  return r;
}

void tell(const char* what, const TreeSelection& s) {
  std::printf("%-24s %zu of %zu trees, %zu of %zu prototypes, %zu in view, %s\n", what, s.trees_needed,
              s.trees.size(), s.prototypes_needed, s.prototypes.size(), s.trees_seen, s.reason.c_str());
}

Forest load(const std::string& how, const char* path, double far_light) {
  if (how == "all") return load_forest(path);
  const auto sketch = read_sketch(path);
  std::printf("sketch read after %.2f s of CPU, %.2f GB\n", cpu_s(), peak_gb());
  const auto& materials = sketch->description.forest.materials;
  tell("from a light map",
       trees_for_picture(sketch->outline, materials, request(), RenderMode::kLightMap, 0));
  const TreeSelection chosen =
      trees_for_picture(sketch->outline, materials, request(), RenderMode::kPathTraced, far_light);
  tell("path-traced", chosen);
  return load_prototypes(*sketch, chosen.prototypes);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string how = argv[1];
  if (how == "make") {
    save_forest(stand(), argv[2]);
    std::printf("saved in %.1f s of CPU, %.2f GB\n", cpu_s(), peak_gb());
    return 0;
  }
  const Forest forest = load(how, argv[2], argc > 3 ? std::atof(argv[3]) : 0.1);
  const double loaded_s = cpu_s();
  std::printf("%s: loaded in %.2f s of CPU, peak %.2f GB\n", how.c_str(), loaded_s, peak_gb());
  OpticsRequest optics;
  optics.bands = {"PAR"};
  optics.soil_albedo = {0.1};
  const Image image = render_path_traced(forest, OpticsTable(forest, optics), request(), {});
  double sum = 0;
  for (const float v : image.rgb) sum += v;
  std::printf("%s: picture in %.2f s of CPU, peak %.2f GB, mean radiance %.6f\n", how.c_str(),
              cpu_s() - loaded_s, peak_gb(), sum / static_cast<double>(image.rgb.size()));
}
