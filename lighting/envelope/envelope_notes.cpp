// See envelope_notes.h.
#include "lighting/envelope/envelope_notes.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "sim/base/parallel.h"

namespace sunfleck::envelope {

namespace {

// Below this share the missing bounces stay inside the method's own error.
constexpr double kNotableRecollision = 0.1;

std::string few_elements_note(const Forest& forest) {
  std::size_t few = 0;
  std::string first;
  for (const Prototype& p : forest.prototypes) {
    if (p.foliage.empty() || p.foliage.size() >= kFewElements) continue;
    if (few++ == 0) first = p.name + "' has " + std::to_string(p.foliage.size());
  }
  if (few == 0) return {};
  return "prototype '" + first + " foliage elements (" + std::to_string(few) +
         " prototypes have fewer than " + std::to_string(kFewElements) +
         "): too few for a random medium, depths may be wrong by 10 % and more; " +
         "method 'reference' suits such plants";
}

std::string coarse_note(const BlockerField& field) {
  std::ostringstream out;
  out << std::setprecision(3)
      << "the scene is too wide for cells of 2 to 4 leaf sides within the cell limit: cells of "
      << field.layout().mean_cell_m() << " m (" << field.layout().mean_cell_m() / field.mean_side_m()
      << " leaf sides) blur the crowns";
  return out.str();
}

std::string fine_note(const BlockerField& field) {
  std::ostringstream out;
  out << std::setprecision(3) << "cells of " << field.layout().mean_cell_m()
      << " m are smaller than 2 leaf sides (" << 2.0 * field.mean_side_m()
      << " m): depths may be wrong by tens of percent";
  return out.str();
}

// Area-weighted over all elements.
double mean_recollision(const BlockerField& field, const SectorDepths& depths) {
  const auto& elements = field.elements();
  const double area = ordered_sum(elements.size(), [&](std::size_t i) { return elements[i].area_m2; });
  const double met = ordered_sum(elements.size(), [&](std::size_t i) {
    double escaped = 0.0;
    for (const float depth : depths[i]) escaped += std::exp(-static_cast<double>(depth)) / 8.0;
    return elements[i].area_m2 * (1.0 - escaped);
  });
  return area > 0.0 ? std::clamp(met / area, 0.0, 1.0 - 1e-4) : 0.0;
}

double largest_albedo(const Forest& forest, const OpticsTable& optics, std::size_t band) {
  double albedo = 0.0;
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
    const LeafSums<double> leaf = mean_leaf(forest, optics, band, p);
    albedo = std::max(albedo, 0.5 * (leaf.reflectance + leaf.transmittance));
  }
  return albedo;
}

}  // namespace

std::vector<std::string> scene_notes(const Forest& forest, const BlockerField& field,
                                     const MarchedSectors& sectors) {
  std::vector<std::string> notes;
  const std::string few = few_elements_note(forest);
  if (!few.empty()) notes.push_back(few);
  if (field.layout().coarsened) notes.push_back(coarse_note(field));
  if (field.layout().mean_cell_m() < 1.99 * field.mean_side_m()) notes.push_back(fine_note(field));
  if (sectors.clamped > 0)
    notes.push_back(std::to_string(sectors.clamped) +
                    " parts of wood or large elements cover more than 0.9 of a cell's face and shade as 0.9");
  return notes;
}

std::vector<std::string> missing_bounce_notes(const Forest& forest, const OpticsTable& optics,
                                              const BlockerField& field, const SectorDepths& depths) {
  std::vector<std::string> notes;
  const double recollision = mean_recollision(field, depths);
  for (std::size_t b = 0; b < optics.band_count(); ++b)
    if (optics.soil_albedo(b) > 0.0) {
      notes.push_back("the ground counts as fully lit: under a closed canopy its light is too strong");
      break;
    }
  for (std::size_t b = 0; b < optics.band_count(); ++b) {
    const double again = std::min(1.0, largest_albedo(forest, optics, b)) * recollision;
    if (again < kNotableRecollision) continue;
    std::ostringstream out;
    out << std::setprecision(2) << "band " << optics.bands()[b]
        << ": bounces beyond the first are missing; leaf albedo times recollision chance a*p = " << again
        << ", so all bounces together bring about " << 1.0 / (1.0 - again) << " times the first";
    notes.push_back(out.str());
  }
  return notes;
}

}  // namespace sunfleck::envelope
