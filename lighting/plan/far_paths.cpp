#include "lighting/plan/far_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lighting/trace/probe_path.h"
#include "lighting/trace/surface_sampler.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck::far_trees {
namespace {

constexpr std::uint64_t kOwnStreams = 0xfa27ee5;  // apart from the probes that measure an answer's error
constexpr std::size_t kMeanProbes = 128;

// Notes the trees that a path has to do with.
class Notebook final : public trace::PathWatch {
 public:
  Notebook(const Illumination& light, const std::vector<double>& mean_w_m2,
           const std::vector<double>& surfaces_w_m2)
      : light_(light), sky_(sky_radiance(light)), mean_w_m2_(mean_w_m2), surfaces_w_m2_(surfaces_w_m2) {}

  void met(const RayHit& hit, const Vec3& direction, const std::vector<double>& weight) override {
    if (hit.kind == HitKind::kGround) return;
    const double sky = direction.z > 0 ? kPi * sky_.radiance(direction) : 0.0;
    double most = 0;
    for (std::size_t b = 0; b < weight.size(); ++b) {
      const double brightest = std::max(sky * light_.bands[b].diffuse_horizontal_w_m2, surfaces_w_m2_[b]);
      most = std::max(most, relative(weight[b] * brightest, b));
    }
    events_.push_back({hit.instance, true, static_cast<float>(most)});
  }
  void shaded(const RayHit& by, const std::vector<double>& lost_w_m2) override {
    if (by.kind == HitKind::kGround) return;
    double most = 0;
    for (std::size_t b = 0; b < lost_w_m2.size(); ++b) most = std::max(most, relative(lost_w_m2[b], b));
    if (most > 0) events_.push_back({by.instance, false, static_cast<float>(most)});
  }
  std::vector<PathEvent> take() { return std::exchange(events_, {}); }

 private:
  double relative(double w_m2, std::size_t band) const {
    return mean_w_m2_[band] > 0 ? w_m2 / mean_w_m2_[band] : 0.0;
  }

  const Illumination& light_;
  const SkyRadiance sky_;
  const std::vector<double>&mean_w_m2_, &surfaces_w_m2_;
  std::vector<PathEvent> events_;
};

double largest_albedo(const Forest& forest, const OpticsTable& optics, std::size_t band) {
  double a = optics.soil_albedo(band);
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p)
    for (std::size_t m = 0; m < forest.prototypes[p].materials.size(); ++m) {
      const MaterialOptics& o = optics.material(band, PrototypeId{static_cast<std::uint32_t>(p)}, m);
      a = std::max({a, o.leaf.albedo_front(), o.leaf.albedo_back(), o.bark_reflectance});
    }
  return a;
}

}  // namespace

void PathRecords::add_element(std::vector<std::vector<PathEvent>> paths) {
  SUNFLECK_EXPECTS(paths.size() == 2 * static_cast<std::size_t>(paths_per_face_));
  Element& element = elements_.emplace_back();
  for (const std::vector<PathEvent>& path : paths) {
    element.first_event.push_back(static_cast<std::uint32_t>(element.events.size()));
    element.events.insert(element.events.end(), path.begin(), path.end());
    double sum = 0;
    for (const PathEvent& event : path) sum = std::max(sum, static_cast<double>(event.most));
    largest_ = std::max(largest_, sum);
  }
  element.first_event.push_back(static_cast<std::uint32_t>(element.events.size()));
}

// Irradiance of a face is the mean over its paths; both faces add up.
std::pair<double, double> PathRecords::change(std::size_t index, const std::vector<bool>& gone) const {
  const Element& element = elements_[index];
  double sum[2] = {0, 0};
  for (std::size_t p = 0; p + 1 < element.first_event.size(); ++p)
    for (std::uint32_t e = element.first_event[p]; e < element.first_event[p + 1]; ++e) {
      const PathEvent& event = element.events[e];
      if (!gone[event.tree]) continue;
      sum[p / 2 % 2] += event.most;
      if (event.ends) break;
    }
  const double half = 0.5 * paths_per_face_;
  return {sum[0] / half, sum[1] / half};
}

std::vector<double> PathRecords::sums() const {
  std::vector<double> sum(trees_);
  for (const Element& element : elements_)
    for (const PathEvent& event : element.events) sum[event.tree] += event.most;
  return sum;
}

PathPlan::PathPlan(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
                   const std::vector<std::uint32_t>& selected, const FarTreesOptions& options,
                   const RunControl& control)
    : scene_(scene),
      optics_(optics),
      light_(light),
      selected_(selected),
      options_(options),
      control_(control),
      mean_w_m2_(mean_light_w_m2()),
      surfaces_w_m2_(most_of_surfaces_w_m2()) {}

// Every selected element alike.
std::vector<std::size_t> PathPlan::draw(int half, std::size_t count) const {
  const ForestIndex& index = scene_.receivers().index();
  std::vector<std::size_t> up_to{0};
  for (const std::uint32_t i : selected_)
    up_to.push_back(up_to.back() + index.first_element(i + 1) - index.first_element(i));
  RandomStream random(mix_seed(options_.seed, kOwnStreams), static_cast<std::uint64_t>(half),
                      RandomPurpose::kProbeDraw);
  std::vector<std::size_t> elements;
  for (std::size_t k = 0; k < count; ++k) {
    const auto at = std::min(up_to.back() - 1,
                             static_cast<std::size_t>(random.uniform() * static_cast<double>(up_to.back())));
    const auto tree =
        static_cast<std::size_t>(std::upper_bound(up_to.begin(), up_to.end(), at) - up_to.begin() - 1);
    elements.push_back(index.first_element(selected_[tree]) + at - up_to[tree]);
  }
  return elements;
}

std::vector<double> PathPlan::mean_light_w_m2() const {
  const ProbeOptions few{.seed = mix_seed(options_.seed, kOwnStreams), .paths_per_face = 16, .sun_rays = 16};
  std::vector<double> mean(optics_.band_count());
  for (const ProbeLight& probe : probe_light(scene_, optics_, light_, draw(2, kMeanProbes), few, control_))
    for (std::size_t b = 0; b < mean.size(); ++b)
      mean[b] += probe.bands[b].irradiance_w_m2() / static_cast<double>(kMeanProbes);
  return mean;
}

// a E0 / (1 - a), see far_trees.h; without end where a surface absorbs nothing.
std::vector<double> PathPlan::most_of_surfaces_w_m2() const {
  std::vector<double> most;
  for (std::size_t b = 0; b < optics_.band_count(); ++b) {
    const BandLight& band = light_.bands[b];
    const double first =
        trace::sun_facing_factor(light_) * band.beam_normal_w_m2 + band.diffuse_horizontal_w_m2;
    const double a = largest_albedo(scene_.receivers().forest(), optics_, b);
    most.push_back(a < 1 ? a * first / (1 - a) : std::numeric_limits<float>::max());
  }
  return most;
}

std::vector<std::vector<PathEvent>> PathPlan::paths_of(std::size_t element, std::uint64_t number) const {
  Notebook notebook(light_, mean_w_m2_, surfaces_w_m2_);
  trace::PathTracer tracer(scene_.receivers().forest(), scene_.rays(), optics_, light_);
  tracer.watch(&notebook);
  const trace::SurfaceSampler surface(scene_.receivers(), element);
  std::vector<std::vector<PathEvent>> paths;
  trace::PathLight ignored(optics_.band_count());
  for (int k = 0; k < options_.paths_per_face; ++k)
    for (const bool front : {true, false}) {
      RandomStream random(mix_seed(mix_seed(options_.seed, kOwnStreams), static_cast<std::uint64_t>(k)),
                          2 * number + (front ? 0 : 1), RandomPurpose::kProbePaths);
      const trace::SurfacePoint at = surface.sample(random);
      const Vec3 direction = trace::cosine_direction(front ? at.normal : -at.normal, random);
      tracer.follow(at.position_m, direction, surface.start(at, front), random, ignored);
      paths.push_back(notebook.take());
    }
  return paths;
}

PathRecords PathPlan::trace(int half) const {
  const std::vector<std::size_t> elements = draw(half, static_cast<std::size_t>(options_.elements / 2));
  std::vector<std::vector<std::vector<PathEvent>>> found(elements.size());
  for_each_chunk(elements.size(), 8, control_, "finding far trees", [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      control_.check();
      found[i] = paths_of(elements[i], static_cast<std::uint64_t>(half) * elements.size() + i);
    }
  });
  PathRecords records(scene_.receivers().forest().instances.size(), options_.paths_per_face);
  for (std::vector<std::vector<PathEvent>>& paths : found) records.add_element(std::move(paths));
  return records;
}

}  // namespace sunfleck::far_trees
