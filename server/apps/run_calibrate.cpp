#include <cstdio>

#include "lighting/study/calibrate.h"
#include "server/apps/commands.h"
#include "server/apps/outputs.h"
#include "server/apps/scene_file.h"
#include "server/apps/terminal.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"
#include "sim/config/config_table.h"

namespace sunfleck {
namespace {

void print_parameter(const CalibratedParameter& p, double confidence) {
  std::printf("%-24s %.3f  (%g %%: %s%.3f to %.3f%s)\n", p.name.c_str(), p.value, 100 * confidence,
              p.low_open ? "below " : "", p.low, p.high, p.high_open ? " and above" : "");
}

void print_fit(const char* what, const SensorFit& fit) {
  std::printf("%-24s rmse %.4f, bias %+.4f, correlation %.3f\n", what, fit.rmse, fit.bias, fit.correlation);
}

std::string table_of(const Calibration& c, const StandStudySpec& study) {
  std::string csv = "id_sensor,x,y,pacl_measured,pacl_fitted,pacl_before\n";
  for (std::size_t i = 0; i < c.sensors.size(); ++i) {
    const LightSensor& sensor = study.sensors[c.sensors[i]].sensor;
    char line[200];
    std::snprintf(line, sizeof line, "%.60s,%.10g,%.10g,%.4f,%.4f,", sensor.name.c_str(), sensor.position_m.x,
                  sensor.position_m.y, c.measured[i], c.fitted[i]);
    csv += line;
    if (!c.before.empty()) std::snprintf(line, sizeof line, "%.4f", c.before[i]), csv += line;
    csv += '\n';
  }
  return csv;
}

}  // namespace

void run_calibrate(const CalibrateOptions& o, const RunControl& control) {
  if (!o.csv.empty()) check_outputs("calibrate", {{"--csv", o.csv, ".csv"}});
  const ConfigTable scene = ConfigTable::from_file(o.scene);
  const ConfigTable forest_table = scene.table("forest"), light_table = scene.table("stand_light");
  const ForestSpec forest = read_forest_spec(forest_table);
  const StandStudySpec study = read_stand_study(light_table);
  forest_table.reject_unread();
  light_table.reject_unread();
  CalibrationOptions options;
  options.understorey = o.understorey;
  options.realisations = o.realisations;
  const SpeciesLibrary species = SpeciesLibrary::load(find_configs(o.configs) / "species");
  const Calibration c = calibrate(forest, species, study, options, control);
  finish_progress();
  for (const CalibratedParameter& p : c.parameters) print_parameter(p, options.confidence);
  if (c.fit_before) print_fit("before", *c.fit_before);
  print_fit("fitted", c.fit);
  const SplitHalf halves = split_half(c.emulator, c.measured, fit_options(options));
  if (halves.splits > 0)
    std::printf("%-24s rmse %.4f +- %.4f on the half that was not fitted, %zu splits\n",
                "fitted on half of them", halves.rmse, halves.spread, halves.splits);
  for (const std::string& note : c.notes) std::printf("note         %s\n", note.c_str());
  if (!o.csv.empty()) {
    write_whole_file(o.csv, table_of(c, study));
    std::printf("wrote        %s\n", o.csv.c_str());
  }
}

}  // namespace sunfleck
