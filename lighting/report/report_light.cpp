// The light itself: map, profile, season, sensors, trees.
#include <algorithm>
#include <cmath>

#include "lighting/render/photograph_file.h"
#include "lighting/report/html.h"
#include "lighting/report/report_sections.h"
#include "lighting/report/stand_photographs.h"
#include "lighting/report/stand_pictures.h"

namespace sunfleck::report {
namespace {

using html::figure;
using html::number;

constexpr std::size_t kMostPhotographs = 16, kMostTreeRows = 1000, kMostIntervalRows = 400;
constexpr int kPhotographPx = 200;

std::string plot_figure(const Page& page, const std::optional<PlotPage>& plot, const char* name,
                        const std::string& alt, const std::string& caption, const char* css_class = "wide") {
  if (!plot) return {};
  const std::filesystem::path file = page.scratch / (std::string(name) + ".svg");
  draw_plots(*plot, file);
  return "<figure>" + html::image(file, alt, css_class) + "<figcaption>" + caption +
         "</figcaption></figure>\n";
}

std::string percent(const StandTable& table, const char* name, std::size_t at, int digits = 1) {
  const StandVariable* v = table.find(name);
  if (!v) return "&ndash;";
  return html::number_with_error(v->value[at], v->standard_error.empty() ? 0 : v->standard_error[at], digits,
                                 100);
}

std::string plain(const StandTable& table, const char* name, std::size_t at, int digits = 2) {
  const StandVariable* v = table.find(name);
  if (!v) return "&ndash;";
  return html::number_with_error(v->value[at], v->standard_error.empty() ? 0 : v->standard_error[at], digits);
}

// A fisheye picture with the quarters of the compass; east is on the left because it looks up.
std::string photograph_figure(const Page& page, const HemisphericalPhotograph& photograph, std::size_t s) {
  const std::filesystem::path file = page.scratch / ("photograph" + std::to_string(s) + ".png");
  save_png(photograph, file);
  const std::string name = sensor_name(page.tables, s);
  return "<figure class=\"photo\"><div class=\"compass\">" +
         html::image(file, "Hemispherical photograph at sensor " + std::to_string(s + 1)) +
         "<i class=\"n\">N</i><i class=\"e\">E</i><i class=\"s\">S</i><i "
         "class=\"w\">W</i></div><figcaption>" +
         name + "</figcaption></figure>\n";
}

std::string photograph_sheet(const Page& page, const RunControl& control) {
  if (!page.study.period || page.study.spec.sensors.empty()) return {};
  const auto pictures = photographs(page.forest, page.study.spec, kPhotographPx, kMostPhotographs, control);
  std::string out = "<h3>What the sensors see</h3>\n<div class=\"photos\">\n";
  for (std::size_t s = 0; s < pictures.size(); ++s) out += photograph_figure(page, pictures[s], s);
  out +=
      "</div>\n<p class=\"quiet\">Looking straight up; the zenith angle grows evenly from the middle to the "
      "horizon "
      "at the rim. North is at the top and east on the left.";
  if (page.tables.sensors.size() > pictures.size())
    out += " The first " + std::to_string(pictures.size()) + " of " +
           std::to_string(page.tables.sensors.size()) + " sensors; --photographs writes all.";
  return out + "</p>\n";
}

std::string light_table(const Page& page, const StandTable& table) {
  const bool measured = table.find("measured_pacl") != nullptr;
  std::vector<std::string> header = {"Sensor", "x, y, height (m)", "Light (%)", "direct (%)", "diffuse (%)"};
  if (measured) header.insert(header.begin() + 3, {"measured (%)", "difference"});
  header.push_back("PAR (mol&nbsp;m<sup>&minus;2</sup>)");
  html::Table out(header);
  for (std::size_t s = 0; s < table.rows; ++s) {
    const LightSensor& at = page.tables.sensors[s].sensor;
    std::vector<std::string> cells = {
        sensor_name(page.tables, s),
        number(at.position_m.x, 1) + ", " + number(at.position_m.y, 1) + ", " + number(at.height_m, 1),
        percent(table, "pacl_total", s), percent(table, "pacl_direct", s), percent(table, "pacl_diffuse", s)};
    if (measured) {
      const double m = table.find("measured_pacl")->value[s];
      cells.insert(cells.begin() + 3,
                   {number(100 * m, 1), number(100 * (table.find("pacl_total")->value[s] - m), 1)});
    }
    cells.push_back(plain(table, "par_photons", s, 1));
    out.row(std::move(cells));
  }
  return out.text(
      "Share of above-canopy light (PACL) at the sensors over the whole period, with standard errors");
}

std::string canopy_table(const Page& page, const StandTable& table) {
  if (!table.find("openness")) return {};
  html::Table out({"Sensor", "Openness (%)", "Sky view (%)", "GLI (%)", "DSF (%)", "ISF (%)", "Effective PAI",
                   "PAI", "Clumping"});
  for (std::size_t s = 0; s < table.rows; ++s)
    out.row({sensor_name(page.tables, s), percent(table, "openness", s), percent(table, "sky_view_factor", s),
             percent(table, "gap_light_index", s), percent(table, "direct_site_factor", s),
             percent(table, "indirect_site_factor", s), plain(table, "effective_plant_area_index", s),
             plain(table, "plant_area_index", s), plain(table, "clumping", s)});
  return out.text(
      "The canopy above the sensors. GLI: gap light index; DSF, ISF: direct and indirect site factor; PAI: "
      "plant area "
      "index (leaves and wood)");
}

std::string gap_table(const Page& page, const StandTable& table) {
  const StandVariable* gaps = table.find("gap_fraction");
  if (!gaps) return {};
  std::vector<std::string> header = {"Sensor"};
  const std::vector<double>& ends = page.tables.ring_bounds_deg;
  for (std::size_t r = 0; r + 1 < ends.size(); ++r)
    header.push_back(number(ends[r], 0) + "&ndash;" + number(ends[r + 1], 0) + "&deg;");
  html::Table out(header);
  const std::size_t rings = header.size() - 1;
  for (std::size_t s = 0; s < table.rows; ++s) {
    std::vector<std::string> cells = {sensor_name(page.tables, s)};
    for (std::size_t r = 0; r < rings; ++r)
      cells.push_back(
          html::number_with_error(gaps->value[s * rings + r], gaps->standard_error[s * rings + r], 1, 100));
    out.row(std::move(cells));
  }
  return "<details><summary>Gap fractions by zenith angle</summary>" +
         out.text("Share of sky (%) between two zenith angles") + "</details>\n";
}

std::string fit_sentence(const SensorFit& fit) {
  std::string out = "<strong>Against " + std::to_string(fit.sensors) + " measured sensors:</strong> RMSE " +
                    number(fit.rmse, 3) + ", bias " + (fit.bias > 0 ? "+" : "") + number(fit.bias, 3) +
                    " (modelled minus measured), correlation " + number(fit.correlation, 2) +
                    ", all as shares of above-canopy light.";
  return paragraph(out);
}

std::string interval_table(const Page& page) {
  const StandTable& plot = *page.tables.find(StandTarget::kPlot);
  const bool bands = plot.find("absorbed_fraction_par") != nullptr;
  std::vector<std::string> header = {"Interval", "Global (MJ&nbsp;m<sup>&minus;2</sup>)", "diffuse (%)",
                                     "PAR (mol&nbsp;m<sup>&minus;2</sup>)"};
  if (bands) header.insert(header.end(), {"fAPAR (%)", "PAR albedo (%)", "PAR transmittance (%)"});
  html::Table out(header);
  const auto& intervals = page.tables.intervals;
  for (std::size_t i = 0; i < std::min(intervals.size(), kMostIntervalRows + 1); ++i) {
    const double global = plot.find("open_global")->value[i], diffuse = plot.find("open_diffuse")->value[i];
    std::vector<std::string> cells = {i == 0 ? "<b>whole period</b>" : html::escaped(intervals[i]),
                                      figure(global), number(global > 0 ? 100 * diffuse / global : 0, 0),
                                      figure(plot.find("open_par_photons")->value[i])};
    if (bands)
      for (const char* name : {"absorbed_fraction_par", "albedo_par", "transmittance_par"})
        cells.push_back(percent(plot, name, i));
    out.row(std::move(cells));
  }
  return out.text("The plot, interval by interval" +
                  (intervals.size() > kMostIntervalRows + 1
                       ? " (the first " + std::to_string(kMostIntervalRows) + "; all are in plot.csv)"
                       : std::string()));
}

}  // namespace

std::string ground(const Page& page) {
  const auto picture = ground_picture(page.tables);
  if (!picture) return {};
  const std::filesystem::path file = page.scratch / "ground.png";
  draw_ground(page.tables.map, *picture, file);
  std::vector<double> sorted = picture->value;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    return number(sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))], 1);
  };
  std::string out = "<figure>" + html::image(file, "Map of light on the ground", "map") +
                    "<figcaption>Circles: stems. Triangles: sensors.</figcaption></figure>\n";
  const bool share = page.tables.find(StandTarget::kGround, "pacl_total") != nullptr;
  const std::string unit = share ? "&nbsp;%" : "&nbsp;MJ&nbsp;m<sup>&minus;2</sup>";
  return out + paragraph(std::string(share ? "Of open light, half" : "Half") +
                         " of the cells get less than " + at(0.5) + unit + ", one in ten less than " +
                         at(0.1) + unit + " and one in ten more than " + at(0.9) + unit + ".");
}

std::string profile(const Page& page) {
  return plot_figure(
             page, profile_plot(page.tables), "profile", "Profiles of light, absorbed PAR and leaf area",
             "Whole period. Light: unscattered, through a level plane at that height, over the map.") +
         plot_figure(
             page, leaf_projection_plot(page.tables), "projection", "G-function",
             "How much of its area the stand's foliage shows to each zenith angle; 0.5 at all angles: leaves "
             "that point everywhere alike.",
             "half");
}

std::string season(const Page& page) {
  return plot_figure(page, season_plot(page.tables), "season", "The course of the season",
                     "Sums of PAR and shares of light, interval by interval.") +
         interval_table(page);
}

std::string sensors(const Page& page, const RunControl& control) {
  const StandTable* table = page.tables.find(StandTarget::kSensor);
  if (!table) return {};
  std::string out;
  if (page.study.fit) out += fit_sentence(*page.study.fit);
  out +=
      plot_figure(page, scatter_plot(page.study, page.tables), "scatter", "Modelled against measured light",
                  "Grey: the line of agreement. Bars: standard error of the model's rays.", "half");
  return out + light_table(page, *table) + canopy_table(page, *table) + gap_table(page, *table) +
         photograph_sheet(page, control);
}

std::string trees(const Page& page) {
  const StandTable* table = page.tables.find(StandTarget::kTree);
  if (!table) return {};
  const bool absorbed = table->find("absorbed_par_photons") != nullptr;
  std::vector<std::string> header = {
      "Tree",       "Species",          "x, y (m)", "Leaf area (m&sup2;)", "Intercepted (MJ)",
      "alone (MJ)", "Light competition"};
  if (absorbed)
    header.insert(header.end(), {"Absorbed PAR (mol)", "per leaf area (mol&nbsp;m<sup>&minus;2</sup>)"});
  html::Table out(header, 2);
  for (std::size_t k = 0; k < std::min(table->rows, kMostTreeRows); ++k) {
    const TreeRow& tree = page.tables.trees[k];
    const auto with_error = [&](const char* name) {
      const Figure f = figure_of(page.tables, StandTarget::kTree, name, k);
      return figure(f.value) + (f.error > 0 ? "&nbsp;&plusmn;&nbsp;" + figure(f.error) : "");
    };
    std::vector<std::string> cells = {std::to_string(tree.id),
                                      html::escaped(tree.species),
                                      number(tree.foot_m.x, 1) + ", " + number(tree.foot_m.y, 1),
                                      figure(tree.leaf_area_m2),
                                      with_error("intercepted"),
                                      with_error("potential"),
                                      plain(*table, "light_competition", k)};
    if (absorbed) {
      cells.push_back(with_error("absorbed_par_photons"));
      const double mol = figure_of(page.tables, StandTarget::kTree, "absorbed_par_photons", k).value;
      cells.push_back(figure(tree.leaf_area_m2 > 0 ? mol / tree.leaf_area_m2 : std::nan("")));
    }
    out.row(std::move(cells));
  }
  const std::string cut = table->rows > kMostTreeRows
                              ? " The first " + std::to_string(kMostTreeRows) + " of " +
                                    std::to_string(table->rows) + " trees; all are in trees.csv."
                              : "";
  return out.text(
      "Trees over the whole period. Light competition: intercepted / what the tree would intercept alone "
      "in the open (1: no neighbour takes anything)." +
      cut);
}

}  // namespace sunfleck::report
