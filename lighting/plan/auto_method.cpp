#include "lighting/plan/auto_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "lighting/base/summaries.h"
#include "lighting/plan/auto_attempt.h"
#include "lighting/plan/auto_direct.h"
#include "lighting/trace/probe_path.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Smooth methods, cheapest first.
constexpr std::array kLadder = {Method::kGrid};

std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

std::string to_text(const Interval& i) {
  return short_number(i.value) + " [" + short_number(i.low) + ", " + short_number(i.high) + "]";
}

std::string to_text(const Correction& c) {
  return short_number(c.offset_w_m2) + " W m-2 + " + short_number(c.direct) + " direct + " +
         short_number(c.sky) + " sky + " + short_number(c.scattered) + " scattered";
}

void add_probe_settings(const ProbePlan& plan, Provenance& p) {
  p.settings.emplace_back("probes", std::to_string(plan.count));
  p.settings.emplace_back("probe_paths_per_face", std::to_string(plan.paths_per_face));
  p.settings.emplace_back("probe_sun_rays", std::to_string(plan.sun_rays));
  p.settings.emplace_back("probe_seed", std::to_string(plan.seed));
}

void add_error_bar(const ErrorSample& sample, const Resamples& resamples, BandLightMap& band, Provenance& p) {
  const ErrorBar bar = error_bar(sample, resamples);
  p.settings.emplace_back("measured_bias." + band.band, to_text(bar.bias));
  p.settings.emplace_back("measured_element_rms." + band.band, to_text(bar.element_rms));
  if (band.mean_irradiance_standard_error_w_m2 == 0.0)
    band.mean_irradiance_standard_error_w_m2 = bar.mean_standard_error_w_m2;
}

class Ladder {
 public:
  Ladder(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
         const LightRequest& request, const MethodRunner& run, const RunControl& control)
      : optics_(optics),
        light_(light),
        request_(request),
        plan_(request.probes.value_or(ProbePlan{})),
        run_(run),
        control_(control),
        light_scene_(scene),
        forest_(scene.forest),
        index_(scene.index) {}

  LightMap climb() {
    prepare();
    for (const Method method : kLadder) {
      if (try_smooth(method)) return finish();
    }
    try_reference();
    return finish();
  }

 private:
  void prepare() {
    {
      const StageTimer timer(times_, "building ray scene");
      scene_ = std::make_unique<ProbeScene>(trace::KeptRays(forest_, light_scene_.store, control_),
                                            request_.reference.ground);
    }
    const StageTimer timer(times_, "probing");
    probes_ = draw_probes(*scene_, optics_, light_, plan_, control_);
  }

  // As it is, then with traced sun where the probes say that this is enough.
  bool try_smooth(Method method) {
    LightRequest asked = request_;
    asked.method = method;
    LightMap map = run_timed(asked);
    const int rays = request_.automatic.measure == AutoMeasure::kElementRms ? sun_rays_for(map) : 0;
    if (take(judge().judge(to_string(method), rays > 0 ? map : std::move(map),
                           {CorrectionForm::kTotal, CorrectionForm::kParts})))
      return true;
    if (rays == 0) return false;
    {
      const StageTimer timer(times_, "tracing sun");
      trace_direct(*scene_, light_, rays, request_.reference.seed, map, control_);
    }
    for (BandLightMap& band : map.bands) band.has_budget = false, band.budget = {};
    return take(judge().judge(to_string(method) + " with " + std::to_string(rays) + " sun rays",
                              std::move(map), {CorrectionForm::kDiffuse, CorrectionForm::kDiffuseParts}));
  }

  // Shadow rays to each element with which direct light is as exact as the tolerance leaves room for; 0: no
  // number will do. The variance by n spread points is taken as 2 / n^1.5 of that of a single ray.
  int sun_rays_for(const LightMap& map) const {
    if (!trace::has_beam(light_)) return 0;
    constexpr double kMost = 256, kFewest = 4, kSafety = 0.95;
    const std::vector<double> diffuse = judge().error_of_diffuse(map);
    double rays = kFewest;
    for (std::size_t b = 0; b < diffuse.size(); ++b) {
      const double room = std::pow(kSafety * request_.automatic.tolerance, 2) - diffuse[b] * diffuse[b];
      if (!(room > 0.0)) return 0;
      rays = std::max(rays, std::pow(2.0 * one_ray_variance(map.bands[b], b) / room, 2.0 / 3.0));
    }
    return rays <= kMost ? static_cast<int>(std::ceil(rays)) : 0;
  }

  // Of an element's light by a single shadow ray, relative to the mean.
  double one_ray_variance(const BandLightMap& map, std::size_t band) const {
    double sum = 0.0;
    for (const ProbeLight& p : probes_.probes)
      sum += p.bands[band].direct_variance_w2_m4 * plan_.sun_rays / plan_.count;
    const double mean = mean_total_w_m2(map);
    return mean > 0.0 ? sum / (mean * mean) : 0.0;
  }

  void try_reference() {
    constexpr int kFirstRays = 16;
    LightRequest asked = request_;
    asked.method = Method::kReference;
    ReferenceOptions& o = asked.reference;
    o.rays_per_face = o.sun_rays_per_element = kFirstRays;
    if (request_.automatic.measure == AutoMeasure::kElementRms)
      o.target_relative_error = 0.9 * request_.automatic.tolerance;
    try {
      take(judge().judge("reference", run_timed(asked), {}));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kLimitExceeded) throw;
      notes_.push_back(std::string("reference was not run: ") + error.what());
    }
  }

  LightMap run_timed(const LightRequest& asked) {
    LightMap map = run_(asked);
    auto& times = map.provenance.times;
    times_.times.insert(times_.times.end(), times.begin(), times.end());
    times.clear();
    return map;
  }

  Judge judge() const { return {forest_, index_, optics_, probes_, request_.automatic}; }

  // Keeps the better attempt; true if it will do.
  bool take(Attempt attempt) {
    tried_ += (tried_.empty() ? "" : "; ") + attempt.name + " " + short_number(attempt.worst_error);
    const bool tolerable = attempt.tolerable;
    if (!best_ || tolerable || attempt.worst_error < best_->worst_error) best_ = std::move(attempt);
    return tolerable;
  }

  LightMap finish() {
    LightMap map = std::move(best_->map);
    Provenance& p = map.provenance;
    {
      const StageTimer timer(times_, "error bars");
      describe(map);
    }
    p.times = std::move(times_.times);
    p.notes.insert(p.notes.end(), notes_.begin(), notes_.end());
    if (!best_->tolerable)
      p.notes.push_back("tolerance " + short_number(request_.automatic.tolerance) + " of " +
                        to_string(request_.automatic.measure) + " not reached: measured " +
                        short_number(best_->worst_error));
    return map;
  }

  void describe(LightMap& map) const {
    Provenance& p = map.provenance;
    p.settings.emplace_back("tolerance", short_number(request_.automatic.tolerance));
    p.settings.emplace_back("tolerance_measure", to_string(request_.automatic.measure));
    p.settings.emplace_back("chosen_method", best_->name);
    p.settings.emplace_back("tried_methods", tried_);
    add_probe_settings(plan_, p);
    const Resamples resamples(probes_.probes.size(), plan_.seed);
    for (std::size_t b = 0; b < map.bands.size(); ++b) {
      if (const auto& c = best_->bands[b].correction)
        p.settings.emplace_back("correction." + map.bands[b].band, to_text(*c));
      add_error_bar(best_->bands[b].sample, resamples, map.bands[b], p);
    }
  }

  const OpticsTable& optics_;
  const Illumination& light_;
  const LightRequest& request_;
  const ProbePlan plan_;
  const MethodRunner& run_;
  const RunControl& control_;
  const LightScene& light_scene_;
  const Forest& forest_;
  const ForestIndex& index_;
  std::unique_ptr<ProbeScene> scene_;
  ProbeSet probes_;
  Provenance times_;  // of all attempts
  std::optional<Attempt> best_;
  std::string tried_;
  std::vector<std::string> notes_;
};

}  // namespace

LightMap auto_light_map(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                        const LightRequest& request, const MethodRunner& run, const RunControl& control) {
  check_options(request.automatic);
  check_options(request.probes.value_or(ProbePlan{}));
  return Ladder(scene, optics, light, request, run, control).climb();
}

void add_error_bars(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                    const ProbePlan& plan, bool ground, LightMap& map, const RunControl& control) {
  const StageTimer timer(map.provenance, "probing");
  const ProbeScene rays(trace::KeptRays(scene.forest, scene.store, control), ground);
  const ProbeSet probes = draw_probes(rays, optics, light, plan, control);
  const Resamples resamples(probes.probes.size(), plan.seed);
  add_probe_settings(plan, map.provenance);
  for (std::size_t b = 0; b < map.bands.size(); ++b)
    add_error_bar(sample_error(probes, map.bands[b], b), resamples, map.bands[b], map.provenance);
}

}  // namespace sunfleck
