// A forest of very many trees: memory, time to build, and the time of a picture's rays (one primary ray per
// pixel, one shadow ray to the sun from where it ends) against bare Embree: its own instances of the same
// leaves, without our callbacks, for the same rays. Prints one line per scene size.
//   lighting_trace_many_trees [trees ...]
#include <embree3/rtcore.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "lighting/trace/ray_scene.h"
#include "sim/base/random.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

constexpr int kSide_px = 1000, kPrototypes = 24, kLeaves = 20'000, kRepeats = 3;
const Vec3 kToSun = glm::normalize(Vec3(0.5, 0.3, 0.8));

double cpu_s() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  const auto s = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return s(use.ru_utime) + s(use.ru_stime);
}

Forest forest_of(std::size_t trees) {
  Species species;
  species.latin = species.material.name = "tree";
  Forest forest;
  forest.materials = {{"tree", {}}};
  for (int i = 0; i < kPrototypes; ++i) {
    CrownShape crown;
    crown.height_m = 14 + i % 8;
    CrownFill fill;
    fill.elements = kLeaves;
    fill.seed = static_cast<std::uint64_t>(i) + 1;
    forest.prototypes.push_back(crown_prototype(species, crown, fill));
    forest.prototypes.back().wood.clear();  // bare Embree has no such figure
  }
  const double side_m = 6.0 * std::sqrt(static_cast<double>(trees));
  forest.instances.resize(trees);
  for (std::size_t i = 0; i < trees; ++i) {
    RandomStream random(1, i, RandomPurpose::kTestScene);
    Instance& tree = forest.instances[i];
    tree.position_m = {random.uniform(0, side_m), random.uniform(0, side_m), 0};
    tree.prototype.value = static_cast<std::uint32_t>(random.below(kPrototypes));
    tree.yaw_rad = static_cast<float>(random.uniform(0, 2 * kPi));
    tree.scale = static_cast<float>(random.uniform(0.85, 1.15));
    tree.tree.value = static_cast<std::uint32_t>(i);
  }
  return forest;
}

struct Ray {
  Vec3 origin, direction;
};

// A view over the forest from above its middle, the horizon at the upper edge; then the shadow rays.
std::vector<Ray> primary_rays(const Forest& forest) {
  const double side_m = 6.0 * std::sqrt(static_cast<double>(forest.instances.size()));
  std::vector<Ray> rays;
  for (int y = 0; y < kSide_px; ++y)
    for (int x = 0; x < kSide_px; ++x) {
      const double u = (x + 0.5) / kSide_px - 0.5, v = (y + 0.5) / kSide_px;
      rays.push_back({{0.5 * side_m, 0.3 * side_m, 60}, glm::normalize(Vec3(u, 1, -0.02 - 0.7 * v))});
    }
  return rays;
}

std::vector<Ray> shadow_rays(const RayScene& scene, const std::vector<Ray>& primary) {
  std::vector<Ray> rays;
  for (const Ray& r : primary) {
    const RayHit hit = scene.closest_hit(r.origin, r.direction);
    if (hit.kind != HitKind::kSky) rays.push_back({hit.position_m + 1e-3 * hit.normal, kToSun});
  }
  return rays;
}

// Embree alone: quads, its own instances, no filters.
class BareScene {
 public:
  BareScene(const Forest& forest, const Vec3& centre)
      : device_(rtcNewDevice(nullptr)), top_(rtcNewScene(device_)) {
    for (const Prototype& p : forest.prototypes) scenes_.push_back(leaves_of(p));
    for (std::size_t i = 0; i < forest.instances.size(); ++i)
      place(forest.instances[i], centre, static_cast<unsigned>(i));
    rtcCommitScene(top_);
  }
  ~BareScene() {
    for (RTCScene s : scenes_) rtcReleaseScene(s);
    rtcReleaseScene(top_);
    rtcReleaseDevice(device_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;

  bool hits(const Ray& r, const Vec3& centre) const {
    RTCRayHit found;
    found.ray = ray_of(r, centre);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(top_, &context, &found);
    return found.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  bool shades(const Ray& r, const Vec3& centre) const {
    RTCRay ray = ray_of(r, centre);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(top_, &context, &ray);
    return ray.tfar < 0;
  }

 private:
  static RTCRay ray_of(const Ray& r, const Vec3& centre) {
    RTCRay ray{};
    const Vec3f o(r.origin - centre), d(r.direction);
    ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
    ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
    ray.tfar = 1e9f;
    ray.mask = 0xFFFFFFFFu;
    return ray;
  }
  RTCScene leaves_of(const Prototype& p) {
    const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
    auto* points = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 4 * p.foliage.size()));
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), p.foliage.size()));
    for (std::size_t i = 0; i < p.foliage.size(); ++i) {
      const FoliageElement& e = p.foliage[i];
      const Vec3f c = e.centre_m, u = e.half_u_m, v = e.half_v_m;
      const Vec3f quad[] = {c - u - v, c + u - v, c + u + v, c - u + v};
      for (std::size_t k = 0; k < 4; ++k) {
        points[4 * i + k] = quad[k];
        corners[4 * i + k] = static_cast<unsigned>(4 * i + k);
      }
    }
    rtcCommitGeometry(g);
    const RTCScene scene = rtcNewScene(device_);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(scene);
    return scene;
  }
  void place(const Instance& tree, const Vec3& centre, unsigned id) {
    const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(g, scenes_[tree.prototype.value]);
    const float c = std::cos(tree.yaw_rad) * tree.scale, s = std::sin(tree.yaw_rad) * tree.scale;
    const Vec3f at(tree.position_m - centre);
    const float columns[] = {c, s, 0, -s, c, 0, 0, 0, tree.scale, at.x, at.y, at.z};
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(top_, g, id);
    rtcReleaseGeometry(g);
  }
  RTCDevice device_;
  RTCScene top_;
  std::vector<RTCScene> scenes_;
};

template <class F>
double seconds_of(F&& work) {
  double best = 1e9;
  for (int i = 0; i < kRepeats; ++i) {
    const double before = cpu_s();
    work();
    best = std::min(best, cpu_s() - before);
  }
  return best;
}

void run(std::size_t trees) {
  const Forest forest = forest_of(trees);
  const double before = cpu_s();
  const RayScene scene(forest, {.table_from = 1});
  const double build_s = cpu_s() - before;
  const std::size_t prototypes = RayScene(forest_of(1), {.table_from = 1}).memory_bytes();
  std::printf(
      "%zu trees: built in %.2f s CPU, %.0f MB of scene, %.0f of them prototypes; %.1f bytes per tree with "
      "its 40 of the forest\n",
      trees, build_s, 1e-6 * static_cast<double>(scene.memory_bytes()),
      1e-6 * static_cast<double>(prototypes),
      static_cast<double>(scene.memory_bytes() - prototypes) / static_cast<double>(trees) + sizeof(Instance));
  if (trees > 2'000'000) return;
  const std::vector<Ray> primary = primary_rays(forest), shadow = shadow_rays(scene, primary);
  const Vec3 centre = forest_bounds(forest).centre();
  std::size_t ours = 0, bare_hits = 0;
  const double t_primary = seconds_of([&] {
    ours = 0;
    for (const Ray& r : primary) ours += scene.closest_hit(r.origin, r.direction).kind == HitKind::kFoliage;
  });
  const double t_shadow = seconds_of([&] {
    for (const Ray& r : shadow) ours += scene.occluded(r.origin, r.direction);
  });
  const BareScene bare(forest, centre);
  const double b_primary = seconds_of([&] {
    bare_hits = 0;
    for (const Ray& r : primary) bare_hits += bare.hits(r, centre);
  });
  const double b_shadow = seconds_of([&] {
    for (const Ray& r : shadow) bare_hits += bare.shades(r, centre);
  });
  std::printf(
      "  primary %.2f s (bare %.2f, ratio %.2f), shadow %.2f s (bare %.2f, ratio %.2f), together %.2f; hits "
      "%zu and %zu\n",
      t_primary, b_primary, t_primary / b_primary, t_shadow, b_shadow, t_shadow / b_shadow,
      (t_primary + t_shadow) / (b_primary + b_shadow), ours, bare_hits);
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  std::printf("  peak memory of the process with both scenes %.2f GB\n",
              1e-6 * static_cast<double>(use.ru_maxrss));
}

}  // namespace
}  // namespace sunfleck

int main(int argc, char** argv) {
  if (argc < 2) sunfleck::run(100'000);
  for (int i = 1; i < argc; ++i) sunfleck::run(static_cast<std::size_t>(std::atof(argv[i])));
}
