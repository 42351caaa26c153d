#include "lighting/trace/probe_light.h"

#include <algorithm>

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

// Mean of independent values and the variance of that mean.
struct Tally {
  double sum = 0, squares = 0;
  void add(double v) {
    sum += v;
    squares += v * v;
  }
  double variance_of_mean(int n) const {
    return std::max(0.0, squares - sum * sum / n) / (static_cast<double>(n) * (n - 1.0));
  }
};

class Prober {
 public:
  Prober(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
         const ProbeOptions& options, const RunControl& control)
      : scene_(scene),
        light_(light),
        options_(options),
        control_(control),
        bands_(optics.band_count()),
        paths_(scene.receivers().forest(), scene.rays(), optics, light) {}

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
    const SunOnSurface sun =
        sun_on_surface(scene_.rays(), surface, light_, options_.sun_rays, SunPoints::kIndependent, random);
    answer.sunlit_fraction = sun.seen;
    for (std::size_t b = 0; b < bands_; ++b) {
      const double beam = light_.bands[b].beam_normal_w_m2;
      answer.bands[b].front.direct_w_m2 = beam * sun.front;
      answer.bands[b].back.direct_w_m2 = beam * sun.back;
      answer.bands[b].direct_variance_w2_m4 += beam * beam * sun.variance;
    }
  }

  void add_face(const SurfaceSampler& surface, bool front, std::uint64_t number, ProbeLight& answer) {
    const int paths = options_.paths_per_face;
    std::vector<Tally> tallies(bands_);
    for (int k = 0; k < paths; ++k) {
      if (k % 8 == 0) control_.check();
      RandomStream random(mix_seed(options_.seed, static_cast<std::uint64_t>(k)),
                          2 * number + (front ? 0 : 1), RandomPurpose::kProbePaths);
      const SurfacePoint at = surface.sample(random);
      const Vec3 direction = cosine_direction(front ? at.normal : -at.normal, random);
      const PathLight path = paths_.follow(at.position_m, direction, surface.start(at, front), random);
      for (std::size_t b = 0; b < bands_; ++b) {
        ProbeFace& face = front ? answer.bands[b].front : answer.bands[b].back;
        face.sky_w_m2 += path.sky_w_m2[b] / paths;
        face.scattered_w_m2 += path.scattered_w_m2[b] / paths;
        tallies[b].add(path.sky_w_m2[b] + path.scattered_w_m2[b]);
      }
    }
    for (std::size_t b = 0; b < bands_; ++b)
      answer.bands[b].diffuse_variance_w2_m4 += tallies[b].variance_of_mean(paths);
  }

  const ProbeScene& scene_;
  const Illumination& light_;
  const ProbeOptions& options_;
  const RunControl& control_;
  const std::size_t bands_;
  PathTracer paths_;
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
