// See envelope_suitability.h.
#include "lighting/envelope/envelope_suitability.h"

#include <algorithm>
#include <cmath>

#include "lighting/envelope/envelope_notes.h"
#include "lighting/envelope/prepared_parts.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

using namespace envelope;

constexpr double kFewestSides = 1.99;  // of a leaf, per cell
constexpr double kMostSides = 6.0;     // where cells had to be coarser
constexpr double kMostSpread = 0.5;    // a p in a closed canopy
constexpr double kMostClamped = 0.01;  // of the elements, per direction

EnvelopeCondition few_elements(const Forest& forest) {
  std::size_t fewest = SIZE_MAX;
  for (const Prototype& p : forest.prototypes)
    if (!p.foliage.empty()) fewest = std::min(fewest, p.foliage.size());
  return {.name = "fewest_elements",
          .value = static_cast<double>(fewest),
          .limit = static_cast<double>(kFewElements),
          .met = fewest >= kFewElements,
          .consequence =
              "a prototype has too few foliage elements for a random medium: light may be wrong by "
              "10 % and more; method 'reference' suits such plants"};
}

EnvelopeCondition fine_cells(double sides) {
  return {.name = "cell_sides",
          .value = sides,
          .limit = kFewestSides,
          .met = sides >= kFewestSides,
          .consequence = "cells are smaller than 2 leaf sides: light may be wrong by tens of percent"};
}

EnvelopeCondition coarse_cells(double sides) {
  return {.name = "coarse_cells",
          .value = sides,
          .limit = kMostSides,
          .met = sides <= kMostSides,
          .consequence = "cells are larger than 6 leaf sides and blur the crowns"};
}

EnvelopeCondition clamped(const PreparedParts& parts) {
  const double looks = static_cast<double>(parts.field->elements().size() * parts.set.half());
  const double share = static_cast<double>(parts.clamped) / looks;
  return {.name = "clamped_share",
          .value = share,
          .limit = kMostClamped,
          .met = share <= kMostClamped,
          .consequence =
              "parts of wood or large elements cover more than 0.9 of a cell's face and shade as "
              "0.9"};
}

// Area-weighted chance of scattered light to meet foliage again.
double mean_recollision(const PreparedParts& parts) {
  const auto& elements = parts.field->elements();
  const double area = ordered_sum(elements.size(), [&](std::size_t i) { return elements[i].area_m2; });
  const double met = ordered_sum(elements.size(), [&](std::size_t i) {
    double escaping = 0.0;
    const std::span<const float> depths = parts.depths_of(i);
    for (std::size_t k = 0; k < depths.size(); ++k)
      escaping += parts.set.solid_angle_sr[k] / (4.0 * kPi) * std::exp(-static_cast<double>(depths[k]));
    return elements[i].area_m2 * std::clamp(1.0 - escaping, 0.0, 1.0);
  });
  return area > 0.0 ? met / area : 0.0;
}

double largest_albedo(const Forest& forest, const OpticsTable& optics, const PreparedParts& parts) {
  double albedo = 0.0;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p)
    for (const AngleSample& sample : parts.angles[p].samples)
      for (std::size_t b = 0; b < optics.band_count(); ++b)
        albedo = std::max(albedo,
                          optics.material(b, {static_cast<std::uint32_t>(p)}, sample.material).leaf.albedo());
  return albedo;
}

EnvelopeCondition light_spread(const Forest& forest, const OpticsTable& optics, const PreparedParts& parts) {
  const double spread = forest.period ? largest_albedo(forest, optics, parts) * mean_recollision(parts) : 0.0;
  return {.name = "light_spread",
          .value = spread,
          .limit = kMostSpread,
          .met = spread <= kMostSpread,
          .consequence =
              "in a closed canopy of bright leaves scattered light spreads further than the local "
              "bounces take it: layers may be off by 10 to 15 %; method 'grid' suits it"};
}

}  // namespace

EnvelopeSuitability envelope_suitability(const Forest& forest, const OpticsTable& optics,
                                         const EnvelopePrepared& prepared) {
  const PreparedParts& parts = prepared.parts();
  const double sides = parts.field->layout().mean_cell_m() / parts.field->mean_side_m();
  EnvelopeSuitability result;
  result.conditions = {few_elements(forest), fine_cells(sides), coarse_cells(sides), clamped(parts),
                       light_spread(forest, optics, parts)};
  result.suitable = std::ranges::all_of(result.conditions, &EnvelopeCondition::met);
  return result;
}

}  // namespace sunfleck
