#include "lighting/plan/auto_attempt.h"

#include <algorithm>
#include <cmath>

#include "lighting/base/summaries.h"
#include "sim/base/parallel.h"

namespace sunfleck {
namespace {

// A correction must lower the RMS on probes it has not seen by more than this share.
constexpr double kWorthCorrecting = 0.02;

std::vector<LightParts> truths(const ProbeSet& probes, std::size_t band) {
  std::vector<LightParts> parts;
  for (const ProbeLight& p : probes.probes) parts.push_back(parts_of(p.bands[band]));
  return parts;
}

std::vector<LightParts> estimates(const ProbeSet& probes, const BandLightMap& map) {
  std::vector<LightParts> parts;
  for (const ProbeLight& p : probes.probes) parts.push_back(parts_of(map.elements[p.element]));
  return parts;
}

std::vector<double> weights(const ProbeSet& probes, AutoMeasure measure) {
  return measure == AutoMeasure::kBias ? probes.area_m2 : std::vector<double>(probes.area_m2.size(), 1.0);
}

bool bias_is_clear(const PointError& error) {
  return std::abs(error.bias.value) > 2.0 * error.bias.standard_error;
}

double error_in(const PointError& error, AutoMeasure measure) {
  return measure == AutoMeasure::kBias ? std::abs(error.bias.value) : error.element_rms;
}

// For the bias the probes must also be able to tell.
bool within(const PointError& error, const AutoOptions& o) {
  if (error_in(error, o.measure) > o.tolerance) return false;
  return o.measure == AutoMeasure::kElementRms || 1.96 * error.bias.standard_error <= o.tolerance;
}

void apply(const Correction& correction, BandLightMap& band) {
  for_each_chunk(band.elements.size(), 8192, {}, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) band.elements[i] = corrected(band.elements[i], correction);
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

Fitted best_fit(const ProbeSet& probes, const BandLightMap& map, std::size_t band,
                const std::vector<CorrectionForm>& forms, AutoMeasure measure) {
  const auto truth = truths(probes, band), plain = estimates(probes, map);
  const auto weight = weights(probes, measure);
  Fitted best{{}, plain};
  const PointError before = point_error(sample_error(probes, plain, map, band));
  if (measure == AutoMeasure::kBias && !bias_is_clear(before)) return best;
  double lowest = measure == AutoMeasure::kBias ? INFINITY : (1.0 - kWorthCorrecting) * before.element_rms;
  for (const CorrectionForm form : forms) {
    const auto held_out = cross_validated(form, plain, truth, weight);
    const auto correction = fit(form, plain, truth, weight);
    if (!held_out || !correction) continue;
    const PointError after = point_error(sample_error(probes, *held_out, map, band));
    if (after.element_rms >= lowest) continue;
    lowest = after.element_rms;
    best = {correction, *held_out};
  }
  return best;
}

}  // namespace

Attempt Judge::judge(std::string name, LightMap map, const std::vector<CorrectionForm>& forms) const {
  Attempt attempt{std::move(name), std::move(map), {}, 0.0, true};
  std::vector<Fitted> fits;
  for (std::size_t b = 0; b < attempt.map.bands.size(); ++b) {
    fits.push_back(best_fit(probes, attempt.map.bands[b], b, forms, options.measure));
    if (fits.back().correction) apply(*fits.back().correction, attempt.map.bands[b]);
  }
  summarize(forest, index, optics, attempt.map);
  for (std::size_t b = 0; b < fits.size(); ++b) {
    JudgedBand judged{fits[b].correction, sample_error(probes, fits[b].at_probes, attempt.map.bands[b], b)};
    const PointError error = point_error(judged.sample);
    attempt.worst_error = std::max(attempt.worst_error, error_in(error, options.measure));
    attempt.tolerable = attempt.tolerable && within(error, options);
    attempt.bands.push_back(std::move(judged));
  }
  return attempt;
}

std::vector<double> Judge::error_of_diffuse(const LightMap& map) const {
  std::vector<double> errors;
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    const auto truth = truths(probes, b);
    auto known = estimates(probes, map.bands[b]);
    for (std::size_t i = 0; i < known.size(); ++i) known[i].direct_w_m2 = truth[i].direct_w_m2;
    const auto rms = [&](const std::vector<LightParts>& parts) {
      ErrorSample s = sample_error(probes, parts, map.bands[b], b);
      for (std::size_t i = 0; i < parts.size(); ++i)
        s.variance_w2_m4[i] = probes.probes[i].bands[b].diffuse_variance_w2_m4;
      return point_error(s).element_rms;
    };
    double error = rms(known);
    const auto weight = weights(probes, AutoMeasure::kElementRms);
    for (const CorrectionForm form : {CorrectionForm::kDiffuse, CorrectionForm::kDiffuseParts})
      if (const auto held_out = cross_validated(form, known, truth, weight))
        error = std::min(error, rms(*held_out));
    errors.push_back(error);
  }
  return errors;
}

}  // namespace sunfleck
