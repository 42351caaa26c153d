// Line and point plots by gnuplot, as SVG or PNG files: what a person looks at beside the tables.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sunfleck {

enum class PlotStyle { kPoints, kLines, kLinesPoints, kSteps, kBoxes };

struct PlotSeries {
  std::string name = {};  // for the key; empty: none
  PlotStyle style = PlotStyle::kLinesPoints;
  std::vector<double> x = {}, y = {};    // same length; values that are not finite leave a gap
  std::vector<double> y_error = {};      // half height of the error bars; empty: none
  std::string colour = {};               // "#rrggbb"; empty: the next of a palette
  std::vector<std::string> labels = {};  // beside the points; empty: none
};

enum class AxisScale { kLinear, kLog };

struct PlotAxis {
  std::string label;  // with unit
  AxisScale scale = AxisScale::kLinear;
  double from = 0, to = 0;                                 // equal: chosen from the values
  std::vector<std::pair<double, std::string>> ticks = {};  // place and label; empty: numbers
};

struct PlotPanel {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotSeries> series;
  std::vector<std::string> remarks = {};  // small lines below the panel's title
};

struct PlotPage {
  std::vector<PlotPanel> panels;
  int columns = 1;
  int panel_width_px = 640, panel_height_px = 480;
};

// Draws the panels row by row into `path` (.svg or .png), which appears whole or not at all. Throws
// Error(kInvalidInput) for another extension, no panel, or series of unequal length; Error(kInputOutput)
// where gnuplot is missing (it says which package) or refuses.
void draw_plots(const PlotPage& page, const std::filesystem::path& path);

}  // namespace sunfleck
