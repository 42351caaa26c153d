#include "lighting/trace/probe_light.h"

#include <array>

#include "lighting/trace/low_discrepancy.h"
#include "lighting/trace/probe_path.h"
#include "lighting/trace/probe_sun.h"
#include "lighting/trace/surface_sampler.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {

using namespace trace;

namespace {

void check_options(const ProbeOptions& o) {
  const auto check = [](int value, const char* key) {
    if (value < 2 || value > 65536)
      throw_invalid(std::string("probes.") + key, std::to_string(value) + " is out of range", "2 to 65536");
  };
  check(o.paths_per_face, "paths_per_face");
  check(o.sun_rays, "sun_rays");
}

// Rays come in two sets, each spread evenly by a sequence of its own: less noise than rays that know nothing
// of each other, and the sets' difference tells how much.
constexpr int kSets = 2;
int rays_in_set(int rays, int set) { return (rays + kSets - 1 - set) / kSets; }

// Of the mean of two independent values, unbiased.
double variance_of_mean(double a, double b) { return 0.25 * (a - b) * (a - b); }

class Prober {
 public:
  Prober(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
         const ProbeOptions& options, const RunControl& control)
      : scene_(scene),
        light_(light),
        options_(options),
        control_(control),
        bands_(optics.band_count()),
        paths_(scene.receivers().forest(), scene.rays(), optics, light),
        sets_{PathLight(bands_), PathLight(bands_)} {}

  ProbeLight probe(std::size_t element, std::uint64_t number) {
    ProbeLight answer;
    answer.element = element;
    answer.bands.resize(bands_);
    const SurfaceSampler surface(scene_.receivers(), element);
    if (has_beam(light_)) add_sun(surface, number, answer);
    add_face(surface, true, number, answer);
    add_face(surface, false, number, answer);
    return answer;
  }

 private:
  void add_sun(const SurfaceSampler& surface, std::uint64_t number, ProbeLight& answer) const {
    RandomStream random(options_.seed, number, RandomPurpose::kProbeSun);
    std::array<SunOnSurface, kSets> sets;
    for (int i = 0; i < kSets; ++i)
      sets[i] = sun_on_surface(scene_.rays(), surface, light_, rays_in_set(options_.sun_rays, i),
                               SunPoints::kSpread, random);
    const auto& [a, b] = sets;
    answer.sunlit_fraction = 0.5 * (a.seen + b.seen);
    const double variance = variance_of_mean(a.front + a.back, b.front + b.back);
    for (std::size_t k = 0; k < bands_; ++k) {
      const double beam = light_.bands[k].beam_normal_w_m2;
      answer.bands[k].front.direct_w_m2 = beam * 0.5 * (a.front + b.front);
      answer.bands[k].back.direct_w_m2 = beam * 0.5 * (a.back + b.back);
      answer.bands[k].direct_variance_w2_m4 += beam * beam * variance;
    }
  }

  void add_face(const SurfaceSampler& surface, bool front, std::uint64_t number, ProbeLight& answer) {
    const std::uint64_t face = 2 * number + (front ? 0 : 1);
    for (int i = 0; i < kSets; ++i) follow_set(surface, front, face, i);
    for (std::size_t b = 0; b < bands_; ++b) {
      ProbeFace& light = front ? answer.bands[b].front : answer.bands[b].back;
      light.sky_w_m2 = 0.5 * (sets_[0].sky_w_m2[b] + sets_[1].sky_w_m2[b]);
      light.scattered_w_m2 = 0.5 * (sets_[0].scattered_w_m2[b] + sets_[1].scattered_w_m2[b]);
      answer.bands[b].diffuse_variance_w2_m4 +=
          variance_of_mean(sets_[0].sky_w_m2[b] + sets_[0].scattered_w_m2[b],
                           sets_[1].sky_w_m2[b] + sets_[1].scattered_w_m2[b]);
    }
  }

  // The mean of a set of paths.
  void follow_set(const SurfaceSampler& surface, bool front, std::uint64_t face, int set) {
    PathLight& mean = sets_[static_cast<std::size_t>(set)];
    mean.clear();
    const int paths = rays_in_set(options_.paths_per_face, set);
    const ScrambledPoints points(mix_seed(options_.seed, kSets * face + static_cast<std::uint64_t>(set)));
    for (int k = 0; k < paths; ++k) {
      if (k % 8 == 0) control_.check();
      const CubePoint x = points(static_cast<std::uint32_t>(k));
      const SurfacePoint at = surface.sample_at(x[2], x[3], x[4]);
      // A needle turned any way sends its cosine-distributed rays anywhere alike.
      const Vec3 direction = surface.is_shoot()
                                 ? any_direction(x[0], x[1])
                                 : cosine_direction(front ? at.normal : -at.normal, x[0], x[1]);
      RandomStream random(mix_seed(options_.seed, static_cast<std::uint64_t>(kSets * k + set)), face,
                          RandomPurpose::kProbePaths);
      paths_.follow(at.position_m, direction, surface.start(at, front), random, mean);
    }
    mean.scale(1.0 / paths);
  }

  const ProbeScene& scene_;
  const Illumination& light_;
  const ProbeOptions& options_;
  const RunControl& control_;
  const std::size_t bands_;
  PathTracer paths_;
  std::array<PathLight, kSets> sets_;
};

}  // namespace

ProbeScene::ProbeScene(const Forest& forest, bool ground, const RunControl& control)
    : surfaces_(std::make_shared<const Surfaces>(forest, GroundCells{}, false)),
      rays_(std::make_shared<const RayScene>(forest, RayScene::Options{.ground = ground}, control)) {}

ProbeScene::ProbeScene(const KeptRays& kept, bool ground)
    : surfaces_(kept.plain_surfaces()), rays_(kept.scene(ground)) {}

std::vector<ProbeLight> probe_light(const ProbeScene& scene, const OpticsTable& optics,
                                    const Illumination& light, std::span<const std::size_t> elements,
                                    const ProbeOptions& options, const RunControl& control) {
  check_options(options);
  SUNFLECK_EXPECTS(light.bands.size() == optics.band_count());
  for (const std::size_t e : elements) SUNFLECK_EXPECTS(e < scene.receivers().foliage_count());
  std::vector<ProbeLight> answers(elements.size());
  for_each_chunk(elements.size(), 4, control, "probing", [&](std::size_t begin, std::size_t end) {
    Prober prober(scene, optics, light, options, control);
    for (std::size_t i = begin; i < end; ++i) answers[i] = prober.probe(elements[i], i);
  });
  return answers;
}

}  // namespace sunfleck
