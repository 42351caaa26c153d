#include "lighting/plan/auto_correction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sunfleck {
namespace {

constexpr std::size_t kMostTerms = 4;
constexpr std::size_t kFolds = 10;

struct Terms {
  std::array<double, kMostTerms> x{};
  double y = 0;
};

std::size_t term_count(CorrectionForm form) {
  switch (form) {
    case CorrectionForm::kTotal:
    case CorrectionForm::kDiffuse:
      return 2;
    case CorrectionForm::kDiffuseParts:
    case CorrectionForm::kDiffuseBySun:
    case CorrectionForm::kDiffuseByClose:
      return 3;
    case CorrectionForm::kDiffuseBySunAndClose:
    case CorrectionForm::kParts:
      break;
  }
  return 4;
}

Terms terms_of(CorrectionForm form, const LightParts& e, const LightParts& truth) {
  switch (form) {
    case CorrectionForm::kTotal:
      return {{e.total(), 1.0}, truth.total()};
    case CorrectionForm::kDiffuse:
      return {{e.diffuse(), 1.0}, truth.diffuse()};
    case CorrectionForm::kDiffuseParts:
      return {{e.sky_w_m2, e.scattered_w_m2, 1.0}, truth.diffuse()};
    case CorrectionForm::kDiffuseBySun:
      return {{e.diffuse(), e.sunlit, 1.0}, truth.diffuse()};
    case CorrectionForm::kDiffuseByClose:
      return {{e.diffuse(), e.close, 1.0}, truth.diffuse()};
    case CorrectionForm::kDiffuseBySunAndClose:
      return {{e.diffuse(), e.sunlit, e.close, 1.0}, truth.diffuse()};
    case CorrectionForm::kParts:
      break;
  }
  return {{e.direct_w_m2, e.sky_w_m2, e.scattered_w_m2, 1.0}, truth.total()};
}

Correction correction_of(CorrectionForm form, const std::array<double, kMostTerms>& c) {
  switch (form) {
    case CorrectionForm::kTotal:
      return {c[1], c[0], c[0], c[0]};
    case CorrectionForm::kDiffuse:
      return {c[1], 1.0, c[0], c[0]};
    case CorrectionForm::kDiffuseParts:
      return {c[2], 1.0, c[0], c[1]};
    case CorrectionForm::kDiffuseBySun:
      return {c[2], 1.0, c[0], c[0], c[1]};
    case CorrectionForm::kDiffuseByClose:
      return {c[2], 1.0, c[0], c[0], 0.0, c[1]};
    case CorrectionForm::kDiffuseBySunAndClose:
      return {c[3], 1.0, c[0], c[0], c[1], c[2]};
    case CorrectionForm::kParts:
      break;
  }
  return {c[3], c[0], c[1], c[2]};
}

// Normal equations A c = b.
struct NormalEquations {
  std::array<std::array<double, kMostTerms>, kMostTerms> a{};
  std::array<double, kMostTerms> b{};

  void add(const Terms& t, double weight, std::size_t terms) {
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j < terms; ++j) a[i][j] += weight * t.x[i] * t.x[j];
      b[i] += weight * t.x[i] * t.y;
    }
  }

  // Elimination with the constant last; a term that the earlier ones explain to 1e-9 (a part that is 0
  // everywhere, or the constant where light is the same on all) is left out: its coefficient is 0.
  std::array<double, kMostTerms> solve(std::size_t terms) const {
    auto m = a;
    auto rest = b;
    std::array<bool, kMostTerms> used{};
    for (std::size_t i = 0; i < terms; ++i) {
      used[i] = m[i][i] > 1e-9 * a[i][i] && a[i][i] > 0.0;
      if (!used[i]) continue;
      for (std::size_t k = i + 1; k < terms; ++k) {
        const double f = m[k][i] / m[i][i];
        for (std::size_t j = i; j < terms; ++j) m[k][j] -= f * m[i][j];
        rest[k] -= f * rest[i];
      }
    }
    std::array<double, kMostTerms> c{};
    for (std::size_t i = terms; i-- > 0;) {
      if (!used[i]) continue;
      double sum = rest[i];
      for (std::size_t j = i + 1; j < terms; ++j) sum -= m[i][j] * c[j];
      c[i] = sum / m[i][i];
    }
    return c;
  }
};

template <class Keep>
std::optional<Correction> fit_if(CorrectionForm form, std::span<const LightParts> estimate,
                                 std::span<const LightParts> truth, std::span<const double> weight,
                                 Keep&& keep) {
  const std::size_t terms = term_count(form);
  NormalEquations equations;
  for (std::size_t i = 0; i < estimate.size(); ++i)
    if (keep(i)) equations.add(terms_of(form, estimate[i], truth[i]), weight[i], terms);
  const Correction c = correction_of(form, equations.solve(terms));
  for (const double factor : {c.direct, c.sky, c.scattered})
    if (!(factor >= 0.0 && std::isfinite(factor))) return {};
  if (!std::isfinite(c.offset_w_m2) || !std::isfinite(c.sunlit_w_m2) || !std::isfinite(c.close_w_m2))
    return {};
  return c;
}

}  // namespace

LightParts corrected(const LightParts& light, const Correction& c) {
  LightParts after{c.direct * light.direct_w_m2, c.sky * light.sky_w_m2, c.scattered * light.scattered_w_m2,
                   light.sunlit, light.close};
  const double more = c.offset_w_m2 + c.sunlit_w_m2 * light.sunlit + c.close_w_m2 * light.close;
  const double before = after.diffuse(), diffuse = std::max(0.0, before + more);
  if (before > 0.0) {
    after.sky_w_m2 *= diffuse / before;
    after.scattered_w_m2 *= diffuse / before;
  } else {
    after.scattered_w_m2 = diffuse;
  }
  return after;
}

ElementLight corrected(const ElementLight& light, double sunlit_fraction, const Correction& c,
                       double close_cover) {
  const LightParts before = parts_of(light, sunlit_fraction, close_cover), after = corrected(before, c);
  const auto scale = [](double to, double from) { return from > 0.0 ? to / from : 0.0; };
  const double sky = scale(after.sky_w_m2, before.sky_w_m2),
               scattered = scale(after.scattered_w_m2, before.scattered_w_m2);
  const bool nothing_to_scale = !(before.scattered_w_m2 > 0.0);
  const auto face = [&](const FaceLight& f) {
    const double own = nothing_to_scale ? 0.5 * after.scattered_w_m2 : scattered * f.scattered_w_m2;
    return FaceLight{static_cast<float>(c.direct * f.direct_w_m2), static_cast<float>(sky * f.sky_w_m2),
                     static_cast<float>(own)};
  };
  return {face(light.front), face(light.back), light.absorbed_w};
}

std::optional<Correction> fit(CorrectionForm form, std::span<const LightParts> estimate,
                              std::span<const LightParts> truth, std::span<const double> weight) {
  return fit_if(form, estimate, truth, weight, [](std::size_t) { return true; });
}

std::optional<std::vector<LightParts>> cross_validated(CorrectionForm form,
                                                       std::span<const LightParts> estimate,
                                                       std::span<const LightParts> truth,
                                                       std::span<const double> weight) {
  std::vector<LightParts> predicted(estimate.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const auto c = fit_if(form, estimate, truth, weight, [&](std::size_t i) { return i % kFolds != fold; });
    if (!c) return {};
    for (std::size_t i = fold; i < estimate.size(); i += kFolds) predicted[i] = corrected(estimate[i], *c);
  }
  return predicted;
}

}  // namespace sunfleck
