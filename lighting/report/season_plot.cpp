// The course of the season, in stand_pictures.h.
#include <algorithm>

#include "lighting/report/stand_pictures.h"

namespace sunfleck {
namespace {

constexpr char kGreen[] = "#2f7d4f", kBlue[] = "#2f6f9f", kAmber[] = "#d99a2b", kRed[] = "#b5394c";
constexpr std::size_t kMostTicks = 12;

// Names of the intervals as ticks, thinned to what fits.
std::vector<std::pair<double, std::string>> interval_ticks(const StandTables& t) {
  std::vector<std::pair<double, std::string>> ticks;
  const std::size_t parts = t.intervals.size() - 1, step = (parts + kMostTicks - 1) / kMostTicks;
  for (std::size_t i = 1; i <= parts; i += step) ticks.emplace_back(static_cast<double>(i), t.intervals[i]);
  return ticks;
}

PlotPanel season_panel(const StandTables& t, const std::string& title, const std::string& label) {
  PlotPanel panel{.title = title, .x = {""}, .y = {label}, .series = {}};
  panel.x.ticks = interval_ticks(t);
  panel.x.from = 0.5;
  panel.x.to = static_cast<double>(t.intervals.size()) - 0.5;
  return panel;
}

std::vector<double> part_numbers(const StandTables& t) {
  std::vector<double> x;
  for (std::size_t i = 1; i < t.intervals.size(); ++i) x.push_back(static_cast<double>(i));
  return x;
}

// Mean over the targets of each part, in percent.
std::vector<double> part_means(const StandTables& t, const StandTable& table, const StandVariable& v) {
  std::vector<double> means;
  for (std::size_t i = 1; i < t.intervals.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < table.rows; ++k)
      sum += 100 * v.value[(v.per_interval ? i : 0) * table.rows + k];
    means.push_back(sum / static_cast<double>(table.rows));
  }
  return means;
}

void add_means(const StandTables& t, StandTarget target, const char* name, const char* colour,
               PlotPanel& panel) {
  const StandTable* table = t.find(target);
  if (!table || !table->find("pacl_total")) return;
  panel.series.push_back({.name = name,
                          .style = PlotStyle::kLinesPoints,
                          .x = part_numbers(t),
                          .y = part_means(t, *table, *table->find("pacl_total")),
                          .colour = colour});
}

PlotPanel energy_panel(const StandTables& t) {
  PlotPanel panel = season_panel(t, "Light above the stand and in its leaves", "PAR (mol m-2 per interval)");
  const StandVariable& open = *t.find(StandTarget::kPlot, "open_par_photons");
  const StandVariable* fapar = t.find(StandTarget::kPlot, "absorbed_fraction_par");
  std::vector<double> above(open.value.begin() + 1, open.value.end()), taken;
  panel.y.to = 1.15 * std::max(1e-9, *std::max_element(above.begin(), above.end()));
  panel.y.from = 0;
  for (std::size_t i = 0; fapar && i < above.size(); ++i) taken.push_back(above[i] * fapar->value[i + 1]);
  panel.series.push_back({.name = "above the stand",
                          .style = PlotStyle::kBoxes,
                          .x = part_numbers(t),
                          .y = above,
                          .colour = kAmber});
  if (fapar)
    panel.series.push_back({.name = "absorbed by leaves",
                            .style = PlotStyle::kBoxes,
                            .x = part_numbers(t),
                            .y = taken,
                            .colour = kGreen});
  return panel;
}

}  // namespace

std::optional<PlotPage> season_plot(const StandTables& t) {
  if (t.intervals.size() < 3) return std::nullopt;
  PlotPage page;
  page.columns = 2;
  page.panel_width_px = 570;
  page.panel_height_px = 360;
  page.panels.push_back(energy_panel(t));
  PlotPanel shares = season_panel(t, "Light below the stand", "share of open light (%)");
  add_means(t, StandTarget::kSensor, "mean of sensors", kRed, shares);
  add_means(t, StandTarget::kGround, "mean of the ground", kBlue, shares);
  if (shares.series.empty()) return page;
  double highest = 0;
  for (const PlotSeries& s : shares.series)
    highest = std::max(highest, *std::max_element(s.y.begin(), s.y.end()));
  shares.y.to = highest > 0 ? 1.15 * highest : 1;
  page.panels.push_back(std::move(shares));
  return page;
}

}  // namespace sunfleck
