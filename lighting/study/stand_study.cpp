#include "lighting/study/stand_study.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "lighting/base/summaries.h"
#include "lighting/canopy/large_stand_check.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

constexpr double kMjPerJ = 1e-6;
constexpr std::size_t kMostTreesByRays = 5000, kMostCellsByRays = 250000;

// Rows of the sky's weights in MJ m-2: beam as it is, radiance times the patch's solid angle.
WeightRows sun_rows(const IntervalWeights& weights) {
  WeightRows rows;
  const SparseRows& beam = weights.beam_normal_j_m2;
  for (std::size_t i = 0; i < beam.rows(); ++i) {
    for (std::size_t e = beam.row_begin[i]; e < beam.row_begin[i + 1]; ++e)
      rows.add(beam.column[e], kMjPerJ * beam.value[e]);
    rows.end_row();
  }
  return rows;
}

WeightRows sky_rows(const IntervalWeights& weights, const SkyDirections& sky) {
  WeightRows rows;
  const SparseRows& radiance = weights.sky_radiance_j_m2_sr;
  for (std::size_t i = 0; i < radiance.rows(); ++i) {
    for (std::size_t e = radiance.row_begin[i]; e < radiance.row_begin[i + 1]; ++e)
      rows.add(radiance.column[e], kMjPerJ * radiance.value[e] * sky.solid_angle_sr[radiance.column[e]]);
    rows.end_row();
  }
  return rows;
}

std::vector<std::string> labels(const IntervalWeights& weights) {
  std::vector<std::string> names;
  for (const WeightInterval& interval : weights.intervals) names.push_back(interval.label);
  return names;
}

// Light of a bin or patch arrives evenly from a cone of its size.
StandSky stand_sky(const SkyWeights& weights, const IntervalWeights& which) {
  StandSky sky;
  sky.sun.to_source = weights.to_sun;
  sky.sun.half_angle_rad = weights.sun_half_angle_rad;
  sky.sun.strength = sun_rows(which);
  sky.sky.to_source = weights.sky.to_source;
  for (const double sr : weights.sky.solid_angle_sr)
    sky.sky.half_angle_rad.push_back(cone_half_angle_rad(sr));
  sky.sky.strength = sky_rows(which, weights.sky);
  sky.intervals = labels(which);
  return sky;
}

const IntervalWeights& parts_of(const SkyWeights& weights, IntervalKind kind) {
  switch (kind) {
    case IntervalKind::kMonth:
      return weights.months;
    case IntervalKind::kDay:
      return weights.days;
    case IntervalKind::kHour:
      return weights.hours;
    case IntervalKind::kPeriod:
      break;
  }
  return weights.period;
}

std::size_t cells_of(const Forest& forest, double cell_m) {
  const Vec3 size = forest_bounds(forest).size();
  return static_cast<std::size_t>(std::ceil(size.x / cell_m) * std::ceil(size.y / cell_m));
}

void add_open_light(const IntervalWeights& weights, StandStudy& study) {
  for (std::size_t i = 0; i < weights.intervals.size(); ++i) {
    study.intervals.push_back(weights.intervals[i].label);
    study.interval_begin_s.push_back(weights.intervals[i].begin_s);
    study.interval_end_s.push_back(weights.intervals[i].end_s);
    study.direct_horizontal_mj_m2.push_back(kMjPerJ * weights.direct_horizontal_j_m2[i]);
    study.diffuse_horizontal_mj_m2.push_back(kMjPerJ * weights.diffuse_horizontal_j_m2[i]);
  }
}

StandLightRequest light_request(const StandStudySpec& spec, StandSky sky) {
  StandLightRequest request;
  request.sky = std::move(sky);
  for (const SensorRow& row : spec.sensors) request.sensors.push_back(row.sensor);
  request.scattering = spec.scattering;
  request.canopy_views = spec.canopy_views && !spec.sensors.empty();
  request.rays_per_cell = spec.rays_per_cell;
  request.tree_relative_error = spec.tree_relative_error;
  request.sensor_sun_rays = spec.sensor_sun_rays;
  request.sensor_sky_rays = spec.sensor_sky_rays;
  request.seed = spec.seed;
  return request;
}

void study_by_rays(const Forest& forest, const SkyWeights& weights, const RunControl& control,
                   StandStudy& study) {
  const StandStudySpec& spec = study.spec;
  const OpticsTable optics(forest, spec.optics);
  StandSceneOptions options;
  options.ground_cell_m = spec.ground_cell_m;
  options.layer_m = spec.layer_m;
  if (spec.map_lo_m) options.map_lo_m = spec.map_lo_m, options.map_hi_m = spec.map_hi_m;
  std::optional<StandScene> scene;
  {
    const StageTimer timer(study.provenance, "building the stand");
    scene.emplace(forest, options, control);
  }
  std::optional<DirectionalBasis> basis;
  {
    const StageTimer timer(study.provenance, "light from each direction");
    basis =
        prepare_stand_light(*scene, optics, light_request(spec, stand_sky(weights, weights.period)), control);
  }
  const StageTimer timer(study.provenance, "summing intervals");
  const auto sum = [&](const IntervalWeights& which) {
    return stand_light(*scene, *basis, sun_rows(which), sky_rows(which, weights.sky), labels(which), control);
  };
  study.period = sum(weights.period);
  if (spec.intervals != IntervalKind::kPeriod) study.parts = sum(parts_of(weights, spec.intervals));
}

void say_errors(const LargeStandCheck& check, StandStudy& study) {
  char text[240];
  std::snprintf(
      text, sizeof text,
      "boxes against rays at %zu ground cells: %+.3f of open light in the mean, %.3f each; at %zu trees: "
      "%+.1f %% in the mean, %.1f %% each",
      check.cells, check.ground_bias, check.ground_error, check.trees, 100 * check.tree_bias,
      100 * check.tree_error);
  study.provenance.notes.push_back(text);
}

void study_by_boxes(const Forest& forest, const SkyWeights& weights, const RunControl& control,
                    StandStudy& study) {
  const StandStudySpec& spec = study.spec;
  LargeStandOptions options;
  options.voxel_m = std::max(0.1, 0.5 * spec.ground_cell_m);
  options.seed = spec.seed;
  const StageTimer timer(study.provenance, "light through boxes");
  const LargeStandPrepared prepared = prepare_large_stand(forest, options, control);
  const StandSky sky = stand_sky(weights, parts_of(weights, spec.intervals));
  study.world = large_stand_light(forest, prepared, sky, control);
  const LargeStandCheck check = check_large_stand(forest, prepared, sky, *study.world, {}, control);
  set_errors(check, sky, *study.world);
  say_errors(check, study);
  if (!spec.sensors.empty())
    study.provenance.notes.push_back("sensors need engine = \"rays\": none are in this answer");
}

void compare_with_measurements(StandStudy& study) {
  if (!study.period || study.spec.sensors.empty()) return;
  std::vector<double> modelled, measured;
  for (std::size_t s = 0; s < study.spec.sensors.size(); ++s) {
    if (!study.spec.sensors[s].pacl) continue;
    modelled.push_back(study.period->sensors.pacl_total.at(0, s));
    measured.push_back(*study.spec.sensors[s].pacl);
  }
  if (measured.size() >= 2) study.fit = sensor_fit(modelled, measured);
}

void sign(const Forest& forest, const RadiationSeries& series, StandEngine engine, StandStudy& study) {
  Provenance& p = study.provenance;
  p.method = "stand light, " + to_string(engine);
  p.version = kVersion;
  p.forest_hash = content_hash(forest);
  p.seed = study.spec.seed;
  const auto number = [](double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", v);
    return std::string(text);
  };
  p.settings = {{"latitude_deg", number(study.spec.place.latitude_deg)},
                {"longitude_deg", number(study.spec.place.longitude_deg)},
                {"elevation_m", number(study.spec.place.elevation_m)},
                {"radiation_table", study.spec.radiation.filename().string()},
                {"sky", to_string(study.spec.sky)},
                {"par_fraction", number(study.spec.par.par_fraction)},
                {"umol_per_j", number(study.spec.par.umol_per_j)},
                {"patch_deg", number(study.spec.patch_deg)},
                {"bin_deg", number(study.spec.bin_deg)},
                {"rays_per_cell", number(study.spec.rays_per_cell)}};
  const double all = series.direct_horizontal_j_m2 + series.diffuse_horizontal_j_m2;
  if (all <= 0)
    p.notes.push_back("the sun does not rise in this period, or brings nothing: all light is zero");
  if (all > 0 && series.energy_split_by_correlation_j_m2 > 0)
    p.notes.push_back(number(100 * series.energy_split_by_correlation_j_m2 / all) +
                      " % of the energy was split into direct and diffuse by correlation");
}

}  // namespace

std::string to_string(StandEngine engine) {
  constexpr const char* kNames[] = {"auto", "rays", "boxes"};
  return kNames[static_cast<int>(engine)];
}

StandEngine chosen_engine(const Forest& forest, const StandStudySpec& spec) {
  if (spec.engine != StandEngine::kAuto) return spec.engine;
  const bool small =
      forest.instances.size() <= kMostTreesByRays && cells_of(forest, spec.ground_cell_m) <= kMostCellsByRays;
  return small ? StandEngine::kRays : StandEngine::kBoxes;
}

SensorFit sensor_fit(const std::vector<double>& modelled, const std::vector<double>& measured) {
  SUNFLECK_EXPECTS(modelled.size() == measured.size() && !modelled.empty());
  const double n = static_cast<double>(modelled.size());
  double m = 0, o = 0, squares = 0, mm = 0, oo = 0, mo = 0;
  for (std::size_t i = 0; i < modelled.size(); ++i) {
    m += modelled[i] / n;
    o += measured[i] / n;
    squares += std::pow(modelled[i] - measured[i], 2) / n;
  }
  for (std::size_t i = 0; i < modelled.size(); ++i) {
    mm += std::pow(modelled[i] - m, 2);
    oo += std::pow(measured[i] - o, 2);
    mo += (modelled[i] - m) * (measured[i] - o);
  }
  const double spread = std::sqrt(mm * oo);
  return {modelled.size(), std::sqrt(squares), m - o,
          spread > 0 ? mo / spread : std::numeric_limits<double>::quiet_NaN()};
}

StandStudySpec with_directions(const Forest& forest, StandStudySpec spec) {
  const bool boxes = chosen_engine(forest, spec) == StandEngine::kBoxes;
  if (spec.patch_deg == 0.0) spec.patch_deg = boxes ? 12.0 : 6.0;
  if (spec.bin_deg == 0.0) spec.bin_deg = boxes ? 10.0 : 5.0;
  return spec;
}

StandStudy run_stand_study(const Forest& forest, const StandStudySpec& asked, const RunControl& control) {
  validate(forest);
  if (forest.instances.empty()) throw_invalid("forest", "has no trees", "grow or read a forest with trees");
  StandStudy study;
  study.spec = with_directions(forest, asked);
  const StandStudySpec& spec = study.spec;
  const RadiationTable table = spec.radiation_table ? *spec.radiation_table : read_radiation(spec.radiation);
  const RadiationSeries series = radiation_series(spec.place, spec.period, table, 10, control);
  SkyWeightOptions options;
  options.sky = spec.sky;
  options.patch_deg = spec.patch_deg;
  options.bin_deg = spec.bin_deg;
  options.finest = spec.intervals;
  const SkyWeights weights = sky_weights(series, options, control);
  add_open_light(weights.period, study);
  if (spec.intervals != IntervalKind::kPeriod) add_open_light(parts_of(weights, spec.intervals), study);
  const StandEngine engine = chosen_engine(forest, spec);
  if (engine == StandEngine::kRays)
    study_by_rays(forest, weights, control, study);
  else
    study_by_boxes(forest, weights, control, study);
  compare_with_measurements(study);
  sign(forest, series, engine, study);
  return study;
}

}  // namespace sunfleck
