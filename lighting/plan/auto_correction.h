// Regression of the probes on a cheap estimate: light' = factors * parts of the estimate + offset, per band.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lighting/plan/auto_probe.h"

namespace sunfleck {

// The offset goes to the diffuse light, which never falls below 0.
struct Correction {
  double offset_w_m2 = 0;  // of both faces together
  double direct = 1, sky = 1, scattered = 1;
  // What an element wholly in the sun gets more of diffuse light: its side of the sky is open and its
  // neighbours are lit.
  double sunlit_w_m2 = 0;
  // What the closest leaves take or give per share of the view of both faces that they fill.
  double close_w_m2 = 0;
};

enum class CorrectionForm {
  kTotal,           // one factor for all parts
  kParts,           // a factor for each part
  kDiffuse,         // the direct light is right: one factor for all diffuse light
  kDiffuseParts,    // the same with a factor each for sky and scattered light
  kDiffuseBySun,    // one factor for all diffuse light and the sunlit term: needs sunlit fractions that are
                    // right for each element
  kDiffuseByClose,  // one factor for all diffuse light and the term of the closest leaves
  kDiffuseBySunAndClose  // the two together
};

LightParts corrected(const LightParts& light, const Correction& correction);
// Scales both faces alike; what has no diffuse light to scale gets the offset as scattered light.
ElementLight corrected(const ElementLight& light, double sunlit_fraction, const Correction& correction,
                       double close_cover = 0);

// Least squares, each probe with its weight. Nothing where a factor would be negative or the probes do not
// tell.
std::optional<Correction> fit(CorrectionForm form, std::span<const LightParts> estimate,
                              std::span<const LightParts> truth, std::span<const double> weight);

// Every probe's light corrected by a fit on the nine tenths of the probes that it is not among; nothing where
// one of the fits fails.
std::optional<std::vector<LightParts>> cross_validated(CorrectionForm form,
                                                       std::span<const LightParts> estimate,
                                                       std::span<const LightParts> truth,
                                                       std::span<const double> weight);

}  // namespace sunfleck
