#include "lighting/plan/auto_report.h"

#include <cstdio>

namespace sunfleck {
namespace {

std::string to_text(const Interval& i) {
  return short_number(i.value) + " [" + short_number(i.low) + ", " + short_number(i.high) + "]";
}

}  // namespace

std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

std::string to_text(const Correction& c) {
  std::string text = short_number(c.offset_w_m2) + " W m-2 + " + short_number(c.direct) + " direct + " +
                     short_number(c.sky) + " sky + " + short_number(c.scattered) + " scattered";
  if (c.sunlit_w_m2 != 0.0) text += " + " + short_number(c.sunlit_w_m2) + " W m-2 sunlit fraction";
  if (c.close_w_m2 != 0.0) text += " + " + short_number(c.close_w_m2) + " W m-2 view of closest leaves";
  return text;
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

void add_group_bar(const ErrorSample& sample, AutoMeasure measure, std::uint64_t seed,
                   const std::string& band, Provenance& p) {
  const Resamples resamples(sample.difference_w_m2.size(), seed);
  p.settings.emplace_back("measured_" + to_string(measure) + "." + band,
                          to_text(error_bar(sample, resamples).element_rms));
}

}  // namespace sunfleck
