#include "lighting/map/plot.h"

#include <cmath>
#include <iterator>
#include <sstream>

#include "lighting/map/gnuplot.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Colours come again after eight series; so the points of the next eight are other ones: discs, squares,
// triangles, diamonds.
int point_type(std::size_t series) {
  constexpr int kTypes[] = {7, 5, 9, 13};
  return kTypes[series / 8 % std::size(kTypes)];
}

std::string style_words(const PlotSeries& series, std::size_t number) {
  const std::string points = " pointtype " + std::to_string(point_type(number)) + " pointsize ";
  if (!series.y_error.empty()) return "with yerrorbars" + points + "0.7";
  switch (series.style) {
    case PlotStyle::kPoints:
      return "with points" + points + "0.8";
    case PlotStyle::kLines:
      return "with lines linewidth 2";
    case PlotStyle::kLinesPoints:
      return "with linespoints linewidth 1.5" + points + "0.6";
    case PlotStyle::kSteps:
      return "with histeps linewidth 2";
    case PlotStyle::kBoxes:
      return "with boxes fill solid 0.5";
  }
  return "with lines";
}

void check(const PlotPage& page, const std::filesystem::path& path) {
  if (path.extension() != ".svg" && path.extension() != ".png")
    throw_invalid(path.string(), "plots are not written as '" + path.extension().string() + "'",
                  ".svg or .png");
  if (page.panels.empty() || page.columns < 1) throw_invalid("plot", "has no panel", "at least one");
  for (const PlotPanel& panel : page.panels)
    for (const PlotSeries& s : panel.series)
      if (s.x.size() != s.y.size() || (!s.y_error.empty() && s.y_error.size() != s.y.size()) ||
          (!s.labels.empty() && s.labels.size() != s.y.size()))
        throw_invalid("plot '" + panel.title + "', series '" + s.name + "'", "x and y differ in length",
                      "one y for every x");
}

void write_axis(std::ostream& out, const char* name, const PlotAxis& axis) {
  out << "set " << name << "label " << gnuplot_quoted(axis.label) << "\n";
  out << (axis.scale == AxisScale::kLog ? "set logscale " : "unset logscale ") << name << "\n";
  if (axis.from < axis.to)
    out << "set " << name << "range [" << axis.from << ":" << axis.to << "]\n";
  else
    out << "set " << name << "range [*:*]\n";
  out << "set " << name << "tics autofreq norotate\n";
  if (axis.ticks.empty()) return;
  out << "set " << name << "tics (";
  for (std::size_t i = 0; i < axis.ticks.size(); ++i)
    out << (i == 0 ? "" : ", ") << gnuplot_quoted(axis.ticks[i].second) << ' ' << axis.ticks[i].first;
  out << ")\n";
}

void write_data(std::ostream& out, const std::string& block, const PlotSeries& series) {
  out << block << " << EOD\n";
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) {
      out << "\n";
      continue;
    }
    out << series.x[i] << ' ' << series.y[i];
    if (!series.y_error.empty()) out << ' ' << series.y_error[i];
    if (!series.labels.empty())
      out << ' ' << gnuplot_quoted(series.labels[i].empty() ? " " : series.labels[i]);
    out << "\n";
  }
  out << "EOD\n";
}

void write_panel(std::ostream& out, const PlotPanel& panel, std::size_t number) {
  write_axis(out, "x", panel.x);
  write_axis(out, "y", panel.y);
  out << "unset label\n";
  for (std::size_t i = 0; i < panel.remarks.size(); ++i)
    out << "set label " << gnuplot_quoted(panel.remarks[i]) << " at graph 0.02,"
        << 0.96 - 0.05 * static_cast<double>(i) << " font \",9\"\n";
  out << "set title " << gnuplot_quoted(panel.title) << "\n";
  std::ostringstream plot;
  for (std::size_t s = 0; s < panel.series.size(); ++s) {
    if (panel.series[s].x.empty()) continue;
    const std::string block = "$p" + std::to_string(number) + "s" + std::to_string(s);
    write_data(out, block, panel.series[s]);
    plot << (plot.str().empty() ? "plot " : ", ") << block << " " << style_words(panel.series[s], s);
    if (!panel.series[s].colour.empty()) plot << " linecolor rgb " << gnuplot_quoted(panel.series[s].colour);
    if (panel.series[s].name.empty())
      plot << " notitle";
    else
      plot << " title " << gnuplot_quoted(panel.series[s].name);
    if (!panel.series[s].labels.empty())
      plot << ", " << block << " using 1:2:" << (panel.series[s].y_error.empty() ? 3 : 4)
           << " with labels left offset 0.8,0.4 font \",8\" textcolor rgb '#5d6b64' notitle";
  }
  if (plot.str().empty()) plot << "plot NaN notitle";
  out << plot.str() << "\n";
}

std::string script_of(const PlotPage& page, const std::filesystem::path& picture, bool svg) {
  const int rows = (static_cast<int>(page.panels.size()) + page.columns - 1) / page.columns;
  std::ostringstream out;
  out.precision(10);
  out << "set terminal " << (svg ? "svg noenhanced background rgb 'white'" : "pngcairo noenhanced")
      << " size " << page.columns * page.panel_width_px << "," << rows * page.panel_height_px
      << " font \"sans,11\"\nset output " << gnuplot_quoted(picture.string())
      << "\nset encoding utf8\nset key outside right top vertical Left reverse samplen 1 font \",9\"\n"
      << "set grid linecolor rgb '#dddddd'\nset border 3\nset tics nomirror\n"
      << "set multiplot layout " << rows << "," << page.columns << "\n";
  for (std::size_t p = 0; p < page.panels.size(); ++p) write_panel(out, page.panels[p], p);
  out << "unset multiplot\nset output\n";
  return out.str();
}

}  // namespace

void draw_plots(const PlotPage& page, const std::filesystem::path& path) {
  check(page, path);
  draw_by_gnuplot(path, [&](const std::filesystem::path& picture) {
    return script_of(page, picture, path.extension() == ".svg");
  });
}

}  // namespace sunfleck
