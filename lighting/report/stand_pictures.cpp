#include "lighting/report/stand_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

constexpr char kGreen[] = "#2f7d4f", kBlue[] = "#2f6f9f", kAmber[] = "#d99a2b", kGrey[] = "#9a9a9a",
               kRed[] = "#b5394c";
constexpr std::size_t kMostStems = 3000, kMostSensorMarks = 60;

std::string formatted(const char* format, double a, double b) {
  char text[120];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

std::vector<double> row(const StandVariable& v, std::size_t rows, std::size_t interval, double factor) {
  const std::size_t first = v.per_interval ? interval * rows : 0;
  std::vector<double> out;
  for (std::size_t k = 0; k < rows; ++k) out.push_back(factor * v.value[first + k]);
  return out;
}

std::vector<double> error_row(const StandVariable& v, std::size_t rows, double factor) {
  std::vector<double> out;
  for (std::size_t k = 0; k < rows; ++k) out.push_back(factor * v.standard_error[k]);
  return out;
}

std::string sensor_label(const StandTables& t, std::size_t s) {
  const std::string& name = t.sensors[s].sensor.name;
  return name.empty() ? std::to_string(s + 1) : name;
}

std::vector<double> layer_middles(const StandTables& t, std::size_t rows) {
  std::vector<double> z;
  for (std::size_t k = 0; k < rows; ++k) z.push_back(t.layer_m * (static_cast<double>(k) + 0.5));
  return z;
}

PlotPanel profile_panel(const StandTables& t, StandTarget target, const char* name, const std::string& title,
                        const std::string& x_label, double factor, const char* colour) {
  const StandTable& table = *t.find(target);
  std::vector<double> z = layer_middles(t, table.rows);
  if (target == StandTarget::kLevel)
    for (double& height : z) height -= 0.5 * t.layer_m;
  PlotPanel panel{.title = title, .x = {x_label}, .y = {"height above ground (m)"}, .series = {}};
  panel.series.push_back({.style = PlotStyle::kLinesPoints,
                          .x = row(*table.find(name), table.rows, 0, factor),
                          .y = z,
                          .colour = colour});
  const std::vector<double>& shown = panel.series.front().x;
  if (*std::max_element(shown.begin(), shown.end()) <= 0)
    panel.x.to = 1;  // nothing at all: an axis all the same
  return panel;
}

}  // namespace

std::optional<GroundPicture> ground_picture(const StandTables& t) {
  const StandTable* ground = t.find(StandTarget::kGround);
  if (!ground) return std::nullopt;
  const StandVariable* share = ground->find("pacl_total");
  const StandVariable* shown = share ? share : ground->find("total");
  GroundPicture picture;
  picture.title = share ? "Light on the ground over the whole period" : "Global radiation on the ground";
  picture.value_label = share ? "share of open light (%)" : "MJ m-2";
  picture.value = row(*shown, ground->rows, 0, share ? 100 : 1);
  const double highest = *std::max_element(picture.value.begin(), picture.value.end());
  picture.to = highest > 0 ? highest : 1;
  for (const TreeRow& tree : t.trees)
    if (t.trees.size() <= kMostStems && t.map.contains(tree.foot_m.x, tree.foot_m.y))
      picture.stems.push_back({Vec2(tree.foot_m), 0.004 * std::max(t.map.size_m().x, t.map.size_m().y)});
  for (std::size_t s = 0; s < t.sensors.size() && t.sensors.size() <= kMostSensorMarks; ++s)
    picture.sensors.push_back({t.sensors[s].sensor.position_m, 0, sensor_label(t, s)});
  return picture;
}

std::optional<PlotPage> profile_plot(const StandTables& t) {
  if (!t.find(StandTarget::kLayer) || !t.find(StandTarget::kLevel)) return std::nullopt;
  PlotPage page;
  page.columns = 3;
  page.panel_width_px = 380;
  page.panel_height_px = 460;
  page.panels.push_back(profile_panel(t, StandTarget::kLevel, "light_share", "Light that comes through",
                                      "share of open light (%)", 100, kBlue));
  page.panels.back().x.from = 0;
  page.panels.back().x.to = 100;
  if (t.find(StandTarget::kLayer, "absorbed_par_photons"))
    page.panels.push_back(profile_panel(t, StandTarget::kLayer, "absorbed_par_photons",
                                        "PAR absorbed by leaves", "mol per m2 of ground and m of height",
                                        1 / (t.layer_area_m2 * t.layer_m), kAmber));
  page.panels.push_back(profile_panel(t, StandTarget::kLayer, "leaf_area_density", "Leaf area",
                                      "leaf area density (m2 m-3)", 1, kGreen));
  return page;
}

std::optional<PlotPage> scatter_plot(const StandStudy& study, const StandTables& t) {
  const StandTable* sensors = t.find(StandTarget::kSensor);
  const StandVariable* measured = sensors ? sensors->find("measured_pacl") : nullptr;
  if (!measured) return std::nullopt;
  const StandVariable& modelled = *sensors->find("pacl_total");
  PlotSeries points{.style = PlotStyle::kPoints,
                    .x = row(*measured, sensors->rows, 0, 100),
                    .y = row(modelled, sensors->rows, 0, 100),
                    .y_error = error_row(modelled, sensors->rows, 100),
                    .colour = kRed};
  for (std::size_t s = 0; s < sensors->rows && sensors->rows <= kMostSensorMarks; ++s)
    points.labels.push_back(sensor_label(t, s));
  double highest = 1;
  for (std::size_t s = 0; s < points.x.size(); ++s)
    if (std::isfinite(points.x[s]))
      highest = std::max({highest, points.x[s], points.y[s] + points.y_error[s]});
  const double end = 1.1 * highest;
  PlotPanel panel{.title = "Light at the sensors",
                  .x = {"measured (% of above-canopy light)", AxisScale::kLinear, 0, end},
                  .y = {"modelled (% of above-canopy light)", AxisScale::kLinear, 0, end},
                  .series = {}};
  panel.series.push_back({.style = PlotStyle::kLines, .x = {0, end}, .y = {0, end}, .colour = kGrey});
  panel.series.push_back(std::move(points));
  if (study.fit) {
    panel.remarks.push_back(formatted("RMSE %.3f   bias %+.3f", study.fit->rmse, study.fit->bias));
    panel.remarks.push_back(std::isfinite(study.fit->correlation)
                                ? formatted("correlation %.2f   sensors %.0f", study.fit->correlation,
                                            static_cast<double>(study.fit->sensors))
                                : std::string("correlation: values without spread"));
  }
  PlotPage page;
  page.panels.push_back(std::move(panel));
  page.panel_width_px = 520;
  page.panel_height_px = 500;
  return page;
}

std::optional<PlotPage> leaf_projection_plot(const StandTables& t) {
  const StandVariable* g = t.find(StandTarget::kAngle, "leaf_projection");
  if (!g) return std::nullopt;
  PlotPage page;
  page.panel_width_px = 520;
  page.panel_height_px = 320;
  page.panels.push_back(
      {.title = "Leaf projection (G-function)",
       .x = {"zenith angle (degrees)", AxisScale::kLinear, 0, 90},
       .y = {"projected area per leaf area", AxisScale::kLinear, 0, 1},
       .series = {{.style = PlotStyle::kLinesPoints, .x = t.angles_deg, .y = g->value, .colour = kGreen}}});
  return page;
}

std::vector<std::filesystem::path> save_stand_pictures(const StandStudy& study, const StandTables& tables,
                                                       const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directory(folder, failure);
  if (failure) throw_cannot_write(folder, failure.message());
  std::vector<std::filesystem::path> written;
  if (const auto picture = ground_picture(tables)) {
    draw_ground(tables.map, *picture, folder / "ground_map.png");
    written.push_back(folder / "ground_map.png");
  }
  const auto draw = [&](const std::optional<PlotPage>& page, const char* name) {
    if (!page) return;
    draw_plots(*page, folder / name);
    written.push_back(folder / name);
  };
  draw(profile_plot(tables), "height_profile.png");
  draw(season_plot(tables), "season.png");
  draw(scatter_plot(study, tables), "sensors.png");
  draw(leaf_projection_plot(tables), "leaf_projection.png");
  return written;
}

}  // namespace sunfleck
