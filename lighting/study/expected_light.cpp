#include "lighting/study/expected_light.h"

#include <cmath>

#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

// Nothing but the sensors: no scattering, no views, hardly any rays on the ground.
StandStudySpec sensors_only(StandStudySpec study) {
  study.engine = StandEngine::kRays;
  study.intervals = IntervalKind::kPeriod;
  study.scattering = study.canopy_views = false;
  study.rays_per_cell = 2;
  return study;
}

void check(const StandStudySpec& study, int realisations) {
  if (study.sensors.empty()) throw_invalid("stand_light.sensors", "are missing", "a table with x, y and h_m");
  if (realisations < 1 || realisations > 1000)
    throw_invalid("realisations", "are " + std::to_string(realisations), "1 to 1000");
}

void add_share(const IntervalTable& from, double weight, std::vector<double>& to) {
  for (std::size_t s = 0; s < to.size(); ++s) to[s] += weight * from.at(0, s);
}

}  // namespace

ExpectedLight expected_light(const ForestSpec& forest, const SpeciesLibrary& species,
                             const StandStudySpec& study, int realisations, const RunControl& control) {
  check(study, realisations);
  const StandStudySpec spec = sensors_only(study);
  const std::size_t sensors = spec.sensors.size();
  ExpectedLight mean{realisations,
                     std::vector<double>(sensors),
                     std::vector<double>(sensors),
                     std::vector<double>(sensors),
                     std::vector<double>(sensors),
                     0,
                     {}};
  std::vector<double> squares(sensors);
  const double weight = 1.0 / realisations;
  for (int k = 0; k < realisations; ++k) {
    ForestSpec one = forest;
    if (k > 0) one.seed = mix_seed(forest.seed, static_cast<std::uint64_t>(k));
    const StandStudy light =
        run_stand_study(grow_forest(one, species, control, k == 0 ? &mean.notes : nullptr), spec, control);
    const SensorTables& table = light.period->sensors;
    add_share(table.pacl_total, weight, mean.pacl);
    add_share(table.pacl_direct, weight, mean.pacl_direct);
    add_share(table.pacl_diffuse, weight, mean.pacl_diffuse);
    for (std::size_t s = 0; s < sensors; ++s) squares[s] += weight * std::pow(table.pacl_total.at(0, s), 2);
    mean.leaf_area_index += weight * light.period->plot.leaf_area_index;
  }
  for (std::size_t s = 0; s < sensors && realisations > 1; ++s)
    mean.pacl_spread[s] = std::sqrt(std::max(0.0, squares[s] - mean.pacl[s] * mean.pacl[s]) * realisations /
                                    (realisations - 1));
  return mean;
}

}  // namespace sunfleck
