#include "lighting/study/calibrate.h"

#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr int kLeafNodes = 7, kStemNodes = 4;

void check(const ForestSpec& forest, const CalibrationOptions& o) {
  if (!(o.least_factor >= 1e-3 && o.least_factor < o.most_factor && o.most_factor <= 1e3))
    throw_invalid("calibrate.leaf_area_factor", "has no range", "0.001 <= least < most <= 1000");
  if (!(o.most_stems_factor > 0 && o.most_stems_factor <= 100))
    throw_invalid("calibrate.most_stems_factor", "is out of range", "above 0, up to 100");
  if (!(o.damping_prior_sd > 0 && o.damping_prior_sd <= 100))
    throw_invalid("calibrate.damping_prior_sd", "is out of range", "above 0, up to 100");
  if (!(o.confidence > 0 && o.confidence < 1))
    throw_invalid("calibrate.confidence", "is no probability", "between 0 and 1, say 0.95");
  if (o.understorey && !forest.understorey.add)
    throw_invalid("calibrate", "cannot fit an understorey: the forest has none",
                  "[forest] realism = \"natural\" or a [forest.understorey] table");
}

std::string name_of(const SensorRow& row, std::size_t i) {
  return row.sensor.name.empty() ? "sensors[" + std::to_string(i) + "]" : "sensor " + row.sensor.name;
}

std::vector<std::size_t> measured_sensors(const StandStudySpec& study, std::size_t parameters) {
  std::vector<std::size_t> with;
  for (std::size_t i = 0; i < study.sensors.size(); ++i) {
    const auto& pacl = study.sensors[i].pacl;
    if (!pacl) continue;
    if (!(*pacl >= 0 && *pacl <= 1))
      throw_invalid(name_of(study.sensors[i], i), "pacl " + std::to_string(*pacl) + " is no share of light",
                    "a share of above-canopy light, 0 to 1");
    with.push_back(i);
  }
  if (with.empty())
    throw_invalid("stand_light.sensors", "carry no measurement", "a column pacl with shares from 0 to 1");
  if (with.size() <= parameters)
    throw_invalid("stand_light.sensors",
                  std::to_string(with.size()) + " measured sensors cannot fit " + std::to_string(parameters) +
                      (parameters == 1 ? " parameter" : " parameters") + " and tell how well",
                  "at least " + std::to_string(parameters + 1) + " sensors with a measurement");
  return with;
}

// Evenly in the logarithm; of 1 + factor for stems, of which there may be none.
std::vector<double> nodes(double from, double to, int count) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back(from + (to - from) * i / (count - 1));
  return places;
}

std::vector<EmulatorAxis> axes_of(const CalibrationOptions& o) {
  std::vector<EmulatorAxis> axes{{nodes(std::log(o.least_factor), std::log(o.most_factor), kLeafNodes)}};
  if (o.understorey) axes.push_back({nodes(0, std::log1p(o.most_stems_factor), kStemNodes)});
  return axes;
}

// Of the sensors that were measured.
LightEmulator with_sensors(const LightEmulator& all, const std::vector<std::size_t>& which) {
  LightEmulator some{all.axes, {}};
  for (const std::vector<double>& light : all.values) {
    some.values.emplace_back();
    for (const std::size_t i : which) some.values.back().push_back(light[i]);
  }
  return some;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

std::vector<double> damped(std::vector<double> light, double mean, double share) {
  for (double& v : light) v = mean + share * (v - mean);
  return light;
}

// Runs of light at all nodes.
class Runs {
 public:
  Runs(const ForestSpec& forest, const SpeciesLibrary& species, const StandStudySpec& study,
       const CalibrationOptions& options, const RunControl& control)
      : forest_(forest), species_(species), study_(study), options_(options), control_(control) {}

  void at_nodes(LightEmulator& emulator, Calibration& c) const {
    for (const double leaf : emulator.axes[0].nodes) {
      if (emulator.axes.size() == 1)
        run(std::exp(leaf), 1, emulator, c);
      else
        for (const double stems : emulator.axes[1].nodes) run(std::exp(leaf), std::expm1(stems), emulator, c);
    }
  }

 private:
  void run(double leaf_factor, double stems_factor, LightEmulator& emulator, Calibration& c) const {
    ForestSpec forest = forest_;
    forest.leaf_area_factor *= leaf_factor;
    forest.understorey.stems_factor *= stems_factor;
    const ExpectedLight light = expected_light(forest, species_, study_, options_.realisations, control_);
    emulator.values.push_back(light.pacl);
    c.runs += light.realisations;
    if (c.notes.empty()) c.notes = light.notes;
  }
  const ForestSpec& forest_;
  const SpeciesLibrary& species_;
  const StandStudySpec& study_;
  const CalibrationOptions& options_;
  const RunControl& control_;
};

void judge(const CalibrationOptions& o, const LightEmulator& all, Calibration& c) {
  std::vector<double> best{std::log(c.parameters[0].value)}, one{0.0};
  if (o.understorey) best.push_back(std::log1p(c.parameters[1].value)), one.push_back(std::log1p(1.0));
  const double share = o.damping ? c.parameters.back().value : 1.0;
  const std::vector<double> at_best = c.emulator.at(best);
  c.fitted = damped(at_best, mean_of(at_best), share);
  c.told = damped(all.at(best), mean_of(at_best), share);
  c.fit = sensor_fit(c.fitted, c.measured);
  if (o.least_factor <= 1 && o.most_factor >= 1 && o.most_stems_factor >= 1) {
    c.before = c.emulator.at(one);
    c.fit_before = sensor_fit(c.before, c.measured);
  }
  for (const CalibratedParameter& p : c.parameters) {
    if (p.name == "pattern_share" && p.at_edge)
      c.notes.push_back("the sensors see nothing of the modelled pattern of light: only its mean is used");
    else if (p.at_edge)
      c.notes.push_back(p.name + " fits best at the edge of its range: widen it, or doubt the stand");
    else if (p.low_open || p.high_open)
      c.notes.push_back("the interval of " + p.name + " is open " +
                        (p.low_open && p.high_open ? "on both sides"
                         : p.low_open              ? "below"
                                                   : "above") +
                        ": these sensors do not bound it there");
  }
}

}  // namespace

Calibration calibrate(const ForestSpec& forest, const SpeciesLibrary& species, const StandStudySpec& study,
                      const CalibrationOptions& options, const RunControl& control) {
  check(forest, options);
  Calibration c;
  c.sensors = measured_sensors(study, 1u + (options.understorey ? 1u : 0u) + (options.damping ? 1u : 0u));
  for (const std::size_t i : c.sensors) c.measured.push_back(*study.sensors[i].pacl);
  LightEmulator all{axes_of(options), {}};
  Runs(forest, species, study, options, control).at_nodes(all, c);
  c.emulator = with_sensors(all, c.sensors);
  c.parameters = fit_parameters(c.emulator, c.measured, fit_options(options));
  judge(options, all, c);
  return c;
}

}  // namespace sunfleck
