// What was asked, what stands there, how it was computed.
#include "lighting/report/report_sections.h"

#include <cmath>

#include "lighting/report/html.h"
#include "lighting/report/stand_render.h"
#include "lighting/sky/utc_time.h"

namespace sunfleck::report {
namespace {

using html::escaped;
using html::figure;
using html::number;

std::string card(const std::string& value, const std::string& unit, const std::string& label) {
  return "<div class=\"card\"><b>" + value + (unit.empty() ? "" : "<small> " + unit + "</small>") +
         "</b><span>" + label + "</span></div>\n";
}

std::string percent(const Figure& f, int digits = 1) {
  return html::number_with_error(f.value, f.error, digits, 100);
}

// "2.5 degrees north" and the like.
std::string degrees(double value, const char* positive, const char* negative) {
  return number(std::abs(value), 4) + "&deg;&nbsp;" + (value < 0 ? negative : positive);
}

double mean_of(const StandTables& t, StandTarget target, const std::string& name) {
  const StandTable* table = t.find(target);
  const StandVariable* v = table ? table->find(name) : nullptr;
  if (!v) return std::nan("");
  double sum = 0;
  for (std::size_t k = 0; k < table->rows; ++k) sum += v->value[k];
  return sum / static_cast<double>(table->rows);
}

double own_leaf_area_m2(const StandTables& t) {
  double sum = 0;
  for (const TreeRow& tree : t.trees) sum += tree.leaf_area_m2;
  return sum;
}

std::string intervals_word(IntervalKind kind) {
  constexpr const char* kWords[] = {"none besides the period", "months", "days", "hours"};
  return kWords[static_cast<int>(kind)];
}

std::string period_text(const StandTables& t) {
  return local_time_text(t.begin_s[0], t.utc_offset_minutes) + " to " +
         local_time_text(t.end_s[0], t.utc_offset_minutes);
}

}  // namespace

Figure figure_of(const StandTables& tables, StandTarget target, const std::string& name, std::size_t row) {
  const StandVariable* v = tables.find(target, name);
  if (!v || row >= v->value.size()) return {std::nan(""), 0};
  return {v->value[row], v->standard_error.empty() ? 0 : v->standard_error[row]};
}

std::string section(const std::string& id, const std::string& title, const std::string& content) {
  return content.empty() ? ""
                         : "<section id=\"" + id + "\"><h2>" + title + "</h2>\n" + content + "</section>\n";
}

std::string paragraph(const std::string& text) { return "<p>" + text + "</p>\n"; }

std::string sensor_name(const StandTables& tables, std::size_t s) {
  const std::string& name = tables.sensors[s].sensor.name;
  return name.empty() ? std::to_string(s + 1) : escaped(name);
}

std::string title_of(const Page& page) {
  return page.forest.name.empty() ? "Light in a stand"
                                  : "Light in &ldquo;" + escaped(page.forest.name) + "&rdquo;";
}

std::string key_figures(const Page& page) {
  const StandTables& t = page.tables;
  std::string out = "<div class=\"cards\">\n";
  out += card(html::count(t.trees.size()), "", "trees of the inventory");
  const Figure lai = figure_of(t, StandTarget::kPlot, "leaf_area_index");
  if (std::isfinite(lai.value))
    out += card(number(lai.value, 2), "", "leaf area index (m&sup2; per m&sup2;)");
  out += card(figure(figure_of(t, StandTarget::kPlot, "open_par_photons").value),
              "mol&nbsp;m<sup>&minus;2</sup>", "PAR above the stand");
  const Figure fapar = figure_of(t, StandTarget::kPlot, "absorbed_fraction_par");
  if (std::isfinite(fapar.value)) out += card(percent(fapar), "%", "of it absorbed by leaves (fAPAR)");
  const double ground_share = mean_of(t, StandTarget::kGround, "pacl_total");
  if (std::isfinite(ground_share))
    out += card(number(100 * ground_share, 1), "%", "of open light on the ground");
  if (t.find(StandTarget::kSensor))
    out += card(number(100 * mean_of(t, StandTarget::kSensor, "pacl_total"), 1), "%",
                "of open light at the sensors (mean)");
  if (page.study.fit) out += card(number(page.study.fit->rmse, 3), "", "RMSE against measured sensors");
  return out + "</div>\n";
}

std::string question(const Page& page) {
  const StandTables& t = page.tables;
  const StandStudySpec& spec = page.study.spec;
  const Vec2 size = t.map.size_m();
  const Figure open = figure_of(t, StandTarget::kPlot, "open_global");
  const Figure diffuse = figure_of(t, StandTarget::kPlot, "open_diffuse");
  std::vector<std::pair<std::string, std::string>> rows = {
      {"Place", degrees(t.place.latitude_deg, "north", "south") + ", " +
                    degrees(t.place.longitude_deg, "east", "west") + ", " + number(t.place.elevation_m, 0) +
                    "&nbsp;m above sea level"},
      {"Period", escaped(period_text(t)) + "; intervals: " + intervals_word(spec.intervals)},
      {"Radiation", escaped(spec.radiation.filename().string()) + ": " + figure(open.value) +
                        "&nbsp;MJ&nbsp;m<sup>&minus;2</sup> global on level open ground, " +
                        number(open.value > 0 ? 100 * diffuse.value / open.value : 0, 0) +
                        "&nbsp;% of it diffuse"},
      {"Sky", escaped(to_string(spec.sky))},
      {"PAR", number(t.par.par_fraction, 3) + " of the global energy; " + number(t.par.umol_per_j, 2) +
                  "&nbsp;&micro;mol per J of PAR"},
      {"Stand",
       html::count(t.trees.size()) + " trees with " + figure(own_leaf_area_m2(t)) +
           "&nbsp;m&sup2; of one-sided leaf area" +
           (t.virtual_trees > 0 ? "; " + html::count(t.virtual_trees) +
                                      " more trees that nobody measured stand around them and are in no table"
                                : "")},
      {"Map", number(size.x, 1) + " &times; " + number(size.y, 1) + "&nbsp;m in " + std::to_string(t.map.nx) +
                  " &times; " + std::to_string(t.map.ny) + " cells" +
                  (t.map.periodic ? "; the stand repeats at its borders" : "")},
      {"Sensors", std::to_string(t.sensors.size())}};
  return html::facts(rows);
}

std::string stand_picture(const Page& page, const RunControl& control) {
  const std::filesystem::path file = page.scratch / "stand.png";
  if (const auto why = draw_stand(page.forest, page.tables, file, control))
    return "<p class=\"quiet\">No picture of the stand: " + escaped(*why) + "</p>\n";
  return "<figure>" + html::image(file, "The stand seen from the south-east", "wide") +
         "<figcaption>The inventory's trees from the south-east at noon, lit by a simple method. Only a "
         "picture: no number on this page comes from it.</figcaption></figure>\n";
}

std::string methods(const Page& page) {
  const StandTables& t = page.tables;
  std::string out;
  if (page.study.period) {
    out += paragraph(
        "Rays from the sun's paths and from patches of the sky are followed through every leaf, stem and "
        "branch. What "
        "each direction gives to each tree, cell, layer and sensor is computed once; every interval is then "
        "a weighted "
        "sum. Standard errors (&plusmn;) are those of the rays. They say how well the stand as described was "
        "computed, "
        "not how well the description meets the real stand: leaf area, crown shapes and clumping usually "
        "weigh more.");
    out += paragraph(
        "Light at sensors, on the map and in the height profile is unscattered, as hemispherical photographs "
        "see it. "
        "Absorbed energy, albedo and transmittance include all bounces between leaves, wood and ground.");
  } else {
    out += paragraph(
        "Large stand: light is swept through boxes of leaf area, one sweep per direction. There are no "
        "standard errors, "
        "no sensors and no light scattered by leaves in this answer; engine = &quot;rays&quot; has them.");
  }
  out += paragraph("Photons: mol = MJ of global radiation &times; " + number(t.par.par_fraction, 3) +
                   " &times; " + number(t.par.umol_per_j, 2) +
                   ". The PAR fraction varies with the sky by a few percent.");
  if (t.find(StandTarget::kSensor, "clumping"))
    out += paragraph(
        "Effective plant area index: of randomly placed leaves and wood that would have the same gaps (five "
        "rings "
        "around 7, 23, 38, 53 and 68 degrees). Plant area index: from the logarithms of the gaps in 24 "
        "segments (Lang "
        "and Xiang 1986). Clumping: the first divided by the second.");
  return out;
}

std::string making(const Page& page) {
  const Provenance& p = page.tables.provenance;
  std::string out;
  if (!p.notes.empty()) {
    out += "<ul>\n";
    for (const std::string& note : p.notes) out += "<li>" + escaped(note) + "</li>\n";
    out += "</ul>\n";
  }
  if (p.skipped.empty()) out += paragraph("Nothing was skipped.");
  for (const SkipNote& s : p.skipped)
    out += paragraph("Skipped: " + escaped(s.what) + ", " + escaped(s.reason) +
                     " (bound: " + figure(s.relative_bound) + " of the mean)");
  std::vector<std::pair<std::string, std::string>> rows = {{"Program", "sunfleck " + escaped(p.version)},
                                                           {"Method", escaped(p.method)},
                                                           {"Forest (SHA-256)", escaped(p.forest_hash)},
                                                           {"Seed", std::to_string(p.seed)}};
  for (const auto& [name, value] : p.settings) rows.emplace_back(escaped(name), escaped(value));
  for (const StageTime& time : p.times)
    rows.emplace_back(escaped(time.stage), number(time.wall_s, 2) + "&nbsp;s (" + number(time.cpu_s, 2) +
                                               "&nbsp;s of processor time)");
  return out + "<details><summary>Settings and times</summary>" + html::facts(rows) + "</details>\n";
}

}  // namespace sunfleck::report
