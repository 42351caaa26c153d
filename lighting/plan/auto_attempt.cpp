#include "lighting/plan/auto_attempt.h"

#include <algorithm>
#include <cmath>

#include "lighting/base/summaries.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

// A correction must lower the RMS on probes it has not seen by more than this share, and one more term again.
constexpr double kWorthCorrecting = 0.01;

std::vector<LightParts> truths(const ProbeSet& probes, std::size_t band) {
  std::vector<LightParts> parts;
  for (const ProbeLight& p : probes.probes) parts.push_back(parts_of(p.bands[band]));
  return parts;
}

double at(std::span<const float> values, std::size_t element) {
  return values.empty() ? 0.0 : values[element];
}

std::vector<LightParts> estimates(const ProbeSet& probes, const LightMap& map, std::size_t band,
                                  std::span<const float> close_cover) {
  std::vector<LightParts> parts;
  for (const ProbeLight& p : probes.probes)
    parts.push_back(parts_of(map.bands[band].elements[p.element], map.sunlit_fraction[p.element],
                             at(close_cover, p.element)));
  return parts;
}

std::vector<double> weights(const ProbeSet& probes, AutoMeasure measure) {
  return measure == AutoMeasure::kElementRms ? std::vector<double>(probes.area_m2.size(), 1.0)
                                             : probes.area_m2;
}

bool bias_is_clear(const PointError& error) {
  return std::abs(error.bias.value) > 2.0 * error.bias.standard_error;
}

double error_in(const JudgedBand& band, AutoMeasure measure) {
  if (band.group) return point_error(*band.group).element_rms;
  const PointError error = point_error(band.sample);
  return measure == AutoMeasure::kBias ? std::abs(error.bias.value) : error.element_rms;
}

// For aggregates the probes must also be able to tell: an error of the tolerance must stand out.
bool within(const JudgedBand& band, const AutoOptions& o) {
  if (error_in(band, o.measure) > o.aim()) return false;
  if (o.measure == AutoMeasure::kElementRms) return true;
  const double resolution =
      band.group ? point_error(*band.group).resolution : 1.96 * point_error(band.sample).bias.standard_error;
  return resolution <= o.aim();
}

void apply(const Correction& correction, std::span<const float> sunlit, std::span<const float> close_cover,
           BandLightMap& band) {
  for_each_chunk(band.elements.size(), 8192, {}, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      band.elements[i] = corrected(band.elements[i], sunlit[i], correction, at(close_cover, i));
  });
  band.has_budget = false;
  band.budget = {};
  band.standard_error_w_m2.clear();
  for (TreeLight& tree : band.trees) tree.absorbed_standard_error_w = 0.0;
  band.mean_irradiance_standard_error_w_m2 = 0.0;
}

struct Fitted {
  std::optional<Correction> correction;
  std::vector<LightParts> at_probes;
};

// The error that a correction is to lower: of all light, or of diffuse light alone (in shares of the total
// mean) where direct light stays as it is, whose error would only blur the comparison.
PointError error_to_lower(const ProbeSet& probes, std::vector<LightParts> light, const BandLightMap& map,
                          std::size_t band, bool diffuse_only) {
  if (!diffuse_only) return point_error(sample_error(probes, light, map, band));
  double direct_error = 0.0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double truth = parts_of(probes.probes[i].bands[band]).direct_w_m2;
    direct_error += (light[i].direct_w_m2 - truth) / static_cast<double>(light.size());
    light[i].direct_w_m2 = truth;
  }
  ErrorSample sample = sample_error(probes, light, map, band);
  sample.mean_w_m2 -= direct_error;
  for (std::size_t i = 0; i < light.size(); ++i)
    sample.variance_w2_m4[i] = probes.probes[i].bands[band].diffuse_variance_w2_m4;
  return point_error(sample);
}

bool keeps_direct(CorrectionForm form) {
  return form != CorrectionForm::kTotal && form != CorrectionForm::kParts;
}

Fitted best_fit(const ProbeSet& probes, const LightMap& whole, std::size_t band,
                const std::vector<CorrectionForm>& forms, AutoMeasure measure,
                std::span<const float> close_cover) {
  const BandLightMap& map = whole.bands[band];
  const auto truth = truths(probes, band), plain = estimates(probes, whole, band, close_cover);
  Fitted best{{}, plain};
  if (forms.empty()) return best;
  if (measure == AutoMeasure::kBias && !bias_is_clear(point_error(sample_error(probes, plain, map, band))))
    return best;
  const bool diffuse_only = keeps_direct(forms.front());
  const auto weight = weights(probes, measure);
  double lowest = INFINITY;
  if (measure != AutoMeasure::kBias)
    lowest = (1.0 - kWorthCorrecting) * error_to_lower(probes, plain, map, band, diffuse_only).element_rms;
  for (const CorrectionForm form : forms) {
    const auto held_out = cross_validated(form, plain, truth, weight);
    const auto correction = fit(form, plain, truth, weight);
    if (!held_out || !correction) continue;
    const double after = error_to_lower(probes, *held_out, map, band, diffuse_only).element_rms;
    if (after >= lowest) continue;
    lowest = (1.0 - kWorthCorrecting) * after;
    best = {correction, *held_out};
  }
  return best;
}

}  // namespace

Attempt Judge::judge(std::string name, LightMap map, const std::vector<CorrectionForm>& forms) const {
  Attempt attempt{std::move(name), std::move(map), {}, 0.0, true};
  std::vector<Fitted> fits;
  for (std::size_t b = 0; b < attempt.map.bands.size(); ++b) {
    fits.push_back(best_fit(probes, attempt.map, b, forms, options.measure, close_cover));
    if (fits.back().correction)
      apply(*fits.back().correction, attempt.map.sunlit_fraction, close_cover, attempt.map.bands[b]);
  }
  summarize(forest, index, optics, attempt.map);
  for (std::size_t b = 0; b < fits.size(); ++b) {
    const BandLightMap& band = attempt.map.bands[b];
    JudgedBand judged{fits[b].correction, sample_error(probes, fits[b].at_probes, band, b), {}};
    if (groups) judged.group = sample_group_error(*groups, forest, index, optics, band, b, options.measure);
    attempt.worst_error = std::max(attempt.worst_error, error_in(judged, options.measure));
    attempt.tolerable = attempt.tolerable && within(judged, options);
    attempt.bands.push_back(std::move(judged));
  }
  return attempt;
}

}  // namespace sunfleck
