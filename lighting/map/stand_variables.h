// How the tables of a study become variables: picks rows, scales units, keeps errors.
#pragma once

#include <cmath>
#include <functional>
#include <limits>

#include "lighting/map/stand_tables.h"

namespace sunfleck::stand {

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// Which intervals come from where: the period's table holds row 0, the parts' the others (may be absent).
struct Source {
  const IntervalTable* period = nullptr;
  const IntervalTable* parts = nullptr;
};

// The same member of the light of the period and of its parts.
template <class Pick>
Source source(const StandStudy& study, const Pick& pick) {
  return {study.period ? &pick(*study.period) : nullptr, study.parts ? &pick(*study.parts) : nullptr};
}

enum class Errors { kKeep, kNone };
// Every target of `rows` (all, where empty), times `factor`.
void fill(const Source& source, const std::vector<std::size_t>& rows, double factor, Errors errors,
          StandVariable& variable);

// Per-band absorbed energy: PAR in energy of PAR and in photons, other bands as they are.
template <class Pick>
void add_absorbed(const StandStudy& study, const std::vector<std::size_t>& rows, const std::string& what,
                  const Pick& bands_of, StandTable& table) {
  if (!study.period) return;
  for (std::size_t b = 0; b < bands_of(*study.period).size(); ++b) {
    const std::string& band = study.spec.optics.bands[b];
    const Source from =
        source(study, [&](const StandLight& l) -> const IntervalTable& { return bands_of(l)[b]; });
    const bool is_par = band == "PAR";
    const double share = is_par ? study.spec.par.par_fraction : 1;
    StandVariable energy{"absorbed_" + band_word(band), "MJ", "mj",
                         (is_par ? std::string("PAR") : band + " (were all global radiation of this band)") +
                             " absorbed by " + what + ", all bounces"};
    fill(from, rows, share, Errors::kKeep, energy);
    table.variables.push_back(std::move(energy));
    if (!is_par) continue;
    StandVariable photons{"absorbed_par", "mol", "mol",
                          "photons of PAR absorbed by " + what + ", all bounces"};
    photons.name = "absorbed_par_photons";
    fill(from, rows, share * study.spec.par.umol_per_j, Errors::kKeep, photons);
    table.variables.push_back(std::move(photons));
  }
}

// The tables, one function each; rows and variables stay empty where the study has none.
StandTable plot_table(const StandStudy& study);
// Leaf area index and absorbed fractions of these trees over the plot, in place of all trees over the map.
void count_own_trees(const StandStudy& study, const std::vector<std::size_t>& trees, StandTable& plot);
StandTable angle_table(const StandStudy& study);
StandTable tree_table(const StandStudy& study, const std::vector<std::size_t>& rows);
StandTable sensor_table(const StandStudy& study);
StandTable ground_table(const StandStudy& study);
StandTable layer_table(const StandStudy& study, double ground_m2);
StandTable level_table(const StandStudy& study);

// Sum over the parts as one table of one interval (world light has parts only); shares are weighted by
// `weight` per interval.
IntervalTable whole_of(const IntervalTable& parts, const std::vector<double>& weight);
IntervalTable whole_of(const IntervalTable& parts);

}  // namespace sunfleck::stand
