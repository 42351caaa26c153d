#include "server/apps/stand_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "server/apps/terminal.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostSensors = 40, kMostIntervals = 24;

double value_at(const StandTables& t, StandTarget target, const std::string& name, std::size_t at) {
  const StandVariable* v = t.find(target, name);
  return v && at < v->value.size() ? v->value[at] : std::numeric_limits<double>::quiet_NaN();
}

void print_header(const StandTables& t, const std::string& name) {
  double leaf_m2 = 0;
  for (const TreeRow& tree : t.trees) leaf_m2 += tree.leaf_area_m2;
  std::printf("stand        %s: %s trees", name.c_str(), grouped(t.trees.size()).c_str());
  if (t.virtual_trees > 0)
    std::printf(" and %s around them that nobody measured", grouped(t.virtual_trees).c_str());
  std::printf("; %.6g m2 of one-sided leaf area\n", leaf_m2);
  const double global = value_at(t, StandTarget::kPlot, "open_global", 0);
  const double diffuse = value_at(t, StandTarget::kPlot, "open_diffuse", 0);
  std::printf("period       %s\n", t.intervals[0].c_str());
  std::printf("open light   %.5g MJ m-2 global (%.0f %% of it diffuse), %.5g mol m-2 of PAR\n", global,
              global > 0 ? 100 * diffuse / global : 0.0,
              value_at(t, StandTarget::kPlot, "open_par_photons", 0));
}

void print_plot(const StandTables& t) {
  const double lai = value_at(t, StandTarget::kPlot, "leaf_area_index", 0);
  if (!std::isnan(lai)) std::printf("plot         leaf area index %.2f\n", lai);
  const std::string prefix = "absorbed_fraction_";
  if (const StandTable* plot = t.find(StandTarget::kPlot))
    for (const StandVariable& v : plot->variables) {
      if (!v.name.starts_with(prefix)) continue;
      const std::string band = v.name.substr(prefix.size());
      std::printf(
          "  %-10s leaves absorb %.1f %% (fAPAR where PAR), %.1f %% go back to the sky, %.1f %% reach the "
          "ground\n",
          band.c_str(), 100 * v.value[0], 100 * value_at(t, StandTarget::kPlot, "albedo_" + band, 0),
          100 * value_at(t, StandTarget::kPlot, "transmittance_" + band, 0));
    }
  const StandVariable* ground = t.find(StandTarget::kGround, "pacl_total");
  if (!ground) return;
  std::vector<double> cells(ground->value.begin(),
                            ground->value.begin() + static_cast<std::ptrdiff_t>(t.map.count()));
  std::sort(cells.begin(), cells.end());
  double mean = 0;
  for (const double c : cells) mean += c / static_cast<double>(cells.size());
  std::printf(
      "ground       mean %.1f %% of open light; half of the cells below %.1f %%, one in twenty above %.1f "
      "%%\n",
      100 * mean, 100 * cells[cells.size() / 2], 100 * cells[cells.size() * 19 / 20]);
}

double ground_mean(const StandTables& t, std::size_t interval) {
  const StandTable* ground = t.find(StandTarget::kGround);
  double sum = 0;
  for (std::size_t c = 0; c < ground->rows; ++c)
    sum += ground->find("pacl_total")->value[interval * ground->rows + c];
  return sum / static_cast<double>(ground->rows);
}

void print_intervals(const StandTables& t) {
  if (t.intervals.size() < 2) return;
  const bool fapar = t.find(StandTarget::kPlot, "absorbed_fraction_par") != nullptr;
  std::printf("\n  %-18s %12s %12s %10s%s\n", "interval", "open MJ m-2", "PAR mol m-2", "ground %",
              fapar ? "    fAPAR %" : "");
  const std::size_t last = std::min(t.intervals.size(), kMostIntervals + 1);
  for (std::size_t i = 1; i < last; ++i) {
    std::printf("  %-18s %12.5g %12.5g %10.1f", t.intervals[i].c_str(),
                value_at(t, StandTarget::kPlot, "open_global", i),
                value_at(t, StandTarget::kPlot, "open_par_photons", i), 100 * ground_mean(t, i));
    if (fapar) std::printf(" %10.1f", 100 * value_at(t, StandTarget::kPlot, "absorbed_fraction_par", i));
    std::printf("\n");
  }
  if (last < t.intervals.size()) std::printf("  ... and %zu more in the files\n", t.intervals.size() - last);
  std::printf("\n");
}

// Over the whole period; nothing where fewer than two sensors carry a measurement.
std::optional<SensorFit> fit_of(const StandTables& t) {
  const StandVariable* measured = t.find(StandTarget::kSensor, "measured_pacl");
  if (!measured) return std::nullopt;
  std::vector<double> there, modelled;
  for (std::size_t s = 0; s < measured->value.size(); ++s) {
    if (std::isnan(measured->value[s])) continue;
    there.push_back(measured->value[s]);
    modelled.push_back(value_at(t, StandTarget::kSensor, "pacl_total", s));
  }
  if (there.size() < 2) return std::nullopt;
  return sensor_fit(modelled, there);
}

void print_sensor(const StandTables& t, std::size_t s) {
  const StandVariable& pacl = *t.find(StandTarget::kSensor, "pacl_total");
  const std::string& name = t.sensors[s].sensor.name;
  std::printf("  %-18s %6.1f +- %4.1f", name.empty() ? std::to_string(s + 1).c_str() : name.c_str(),
              100 * pacl.value[s], 100 * pacl.standard_error[s]);
  const double measured = value_at(t, StandTarget::kSensor, "measured_pacl", s);
  if (!std::isnan(measured)) std::printf("  %9.1f %+11.1f", 100 * measured, 100 * (pacl.value[s] - measured));
  std::printf("\n");
}

void print_fit(const SensorFit& fit) {
  std::printf("measured     %zu sensors: RMSE %.3f, bias %+.3f (modelled - measured)", fit.sensors, fit.rmse,
              fit.bias);
  if (std::isnan(fit.correlation))
    std::printf("; no correlation (values without spread)\n");
  else
    std::printf(", correlation %.2f\n", fit.correlation);
}

void print_sensors(const StandTables& t) {
  if (!t.find(StandTarget::kSensor)) return;
  const bool measured = t.find(StandTarget::kSensor, "measured_pacl") != nullptr;
  std::printf("  %-18s %14s%s   (%% of above-canopy light)\n", "sensor", "modelled",
              measured ? "   measured  difference" : "");
  for (std::size_t s = 0; s < std::min(t.sensors.size(), kMostSensors); ++s) print_sensor(t, s);
  if (t.sensors.size() > kMostSensors)
    std::printf("  ... and %zu more in the files\n", t.sensors.size() - kMostSensors);
  if (const auto fit = fit_of(t)) print_fit(*fit);
}

void print_making(const Provenance& p) {
  for (const SkipNote& s : p.skipped)
    std::printf("skipped      %s: %s (bound: %.2g of the mean)\n", s.what.c_str(), s.reason.c_str(),
                s.relative_bound);
  for (const std::string& note : p.notes) std::printf("note         %s\n", note.c_str());
  double wall = 0;
  for (const StageTime& time : p.times) wall += time.wall_s;
  std::printf("time         %s", seconds_text(wall).c_str());
  for (std::size_t i = 0; i < p.times.size(); ++i)
    std::printf("%s%s %s", i == 0 ? " (" : ", ", p.times[i].stage.c_str(),
                seconds_text(p.times[i].wall_s).c_str());
  std::printf("%s\n", p.times.empty() ? "" : ")");
}

}  // namespace

void print_stand(const StandTables& tables, const std::string& name) {
  print_header(tables, name);
  print_plot(tables);
  print_intervals(tables);
  print_sensors(tables);
  print_making(tables.provenance);
}

}  // namespace sunfleck
