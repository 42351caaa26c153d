// What `auto` and probes say of an answer, as settings of its provenance.
#pragma once

#include <string>

#include "lighting/plan/auto_attempt.h"

namespace sunfleck {

std::string short_number(double x);
void add_probe_settings(const ProbePlan& plan, Provenance& p);
// measured_bias.<band> and measured_element_rms.<band>. A band without a standard error of its mean gets one
// that holds bias and uncertainty together.
void add_error_bar(const ErrorSample& sample, const Resamples& resamples, BandLightMap& band, Provenance& p);
// measured_<measure>.<band> of the measure's groups.
void add_group_bar(const ErrorSample& sample, AutoMeasure measure, std::uint64_t seed,
                   const std::string& band, Provenance& p);
std::string to_text(const Correction& c);

}  // namespace sunfleck
