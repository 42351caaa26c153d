// Which leaf area explains the light measured at sensors, how far the stand's pattern of light can be
// trusted, and the light to expect where nothing was measured.
//
// Fitted: a factor on the leaf area of every tree, from least_factor to most_factor; if asked a factor on the
// number of understorey trees (0 to most_stems_factor); and, unless refused, the share d of the modelled
// pattern that is real: light at sensor s is L + d (q_s - L), where q is the expected share of above-canopy
// light (pacl; several realisations, see expected_light.h) and L the mean of q over the measured sensors. An
// inventory tells less of where light is than it seems to (crowns are no ellipsoids, stems are mapped to
// decimetres), so predictions spread too widely: the slope of measured on predicted light lies below 1
// (regression calibration, regression dilution: Fuller 1987). d = 1 is the model as it is, d = 0 its mean
// alone; never below 0.
//
// Least squares over all sensors alike, with the prior d ~ N(1, damping_prior_sd^2): added to the sum of
// squares is s2 ((d - 1) / damping_prior_sd)^2, s2 the variance of the errors as the unpenalised fit on the
// same sensors leaves it (empirical Bayes). The prior of 1 is wide: it says that the model is right, and
// gives way to a few sensors that disagree. Leaf area and stems have no prior. Light is run on a few nodes
// and interpolated (light_emulator.h); the minimum is looked for on a fine net (1.4 % in leaf area, 2 % of
// the range in stems) and exactly in d, so answers are no finer than that.
//
// Interval: profile likelihood with unknown variance of the errors. For p parameters and n sensors all values
// whose least sum of squares (over the other parameters) is at most S_min (1 + t^2 / (n - p)), t the quantile
// of Student's distribution for n - p degrees of freedom (Seber and Wild 1989, Nonlinear regression, 5.23 for
// one parameter). It takes the sensors' errors as independent: neighbours under one crown are not, and the
// interval is then too narrow. An end that reaches the range is open: the sensors do not bound the parameter
// there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lighting/study/expected_light.h"
#include "lighting/study/light_emulator.h"

namespace sunfleck {

struct CalibrationOptions {
  bool understorey = false;  // fit the number of understorey trees too; needs forest.understorey.add
  double least_factor = 0.25, most_factor = 4, most_stems_factor = 6;
  int realisations = 4;         // per run
  double confidence = 0.95;     // (0, 1)
  bool damping = true;          // fit the share of the pattern that is real
  double damping_prior_sd = 1;  // (0, 100]
};

struct CalibratedParameter {
  std::string name;  // "leaf_area_factor", "understorey_stems_factor", "pattern_share"
  double value = 1, low = 1, high = 1;
  bool low_open = false, high_open = false;  // the interval goes on beyond the range that was tried
  bool at_edge = false;                      // so does the best value: nothing was found
};

struct Calibration {
  std::vector<CalibratedParameter> parameters;
  std::vector<std::size_t> sensors;      // those with a measurement, indexes into the study's sensors
  std::vector<double> measured, fitted;  // per such sensor
  std::vector<double> told;              // fitted light at every sensor of the study, measured or not
  std::vector<double> before;            // with both factors at 1; empty where 1 is out of range
  SensorFit fit;
  std::optional<SensorFit> fit_before;
  LightEmulator emulator;  // its axes: ln(leaf area factor), ln(1 + stems factor)
  int runs = 0;            // of one realisation each
  std::vector<std::string> notes;
};

// Throws Error(kInvalidInput): sensors without any measurement, no more sensors than parameters, measurements
// outside [0, 1], ranges or options that make no sense, stems to fit in a forest without understorey.
Calibration calibrate(const ForestSpec& forest, const SpeciesLibrary& species, const StandStudySpec& study,
                      const CalibrationOptions& options, const RunControl& control);

// The estimate alone, from an emulator of the measured sensors; for calibrate() and tests. More sensors than
// parameters.
struct FitOptions {
  double confidence = 0.95;
  bool damping = true;
  double damping_prior_sd = 1;
};
std::vector<CalibratedParameter> fit_parameters(const LightEmulator& emulator,
                                                const std::vector<double>& measured,
                                                const FitOptions& options);
inline FitOptions fit_options(const CalibrationOptions& o) {
  return {o.confidence, o.damping, o.damping_prior_sd};
}

// How well a fit on half of the sensors tells the other half: the mean over splits of the RMSE there.
// Everything is fitted on the one half, the variance behind the prior too; of the other half only its places
// are used. All splits up to 20 sensors, else 10,000 drawn by lot; none where a half has no more sensors than
// there are parameters. Uses the emulator, no new runs (with stems every fourth step of the leaf area's net).
struct SplitHalf {
  double rmse = 0, spread = 0;  // mean and standard deviation over the splits
  std::size_t splits = 0;
};
SplitHalf split_half(const LightEmulator& emulator, const std::vector<double>& measured,
                     const FitOptions& options = {});

// Quantile of |Student's t| that a share `confidence` stays below.
double student_t(double confidence, int degrees_of_freedom);

}  // namespace sunfleck
