#include "lighting/map/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "sim/base/error.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

PlotPage two_panels() {
  PlotPage page;
  page.panels.push_back({.title = "error \"against\" time",
                         .x = {"CPU time (s)", AxisScale::kLog},
                         .y = {"RMS error (%)", AxisScale::kLog},
                         .series = {{"grid_26", PlotStyle::kLinesPoints, {0.1, 1, 10}, {30, 10, 3}, {}}},
                         .remarks = {"a remark"}});
  page.panels.push_back({.title = "profile",
                         .x = {"light (W m-2)"},
                         .y = {"height (m)"},
                         .series = {{"seen", PlotStyle::kPoints, {1, 2}, {3, std::nan("")}, {0.1, 0.2}}}});
  page.columns = 2;
  return page;
}

TEST(Plot, WritesWholeSvgAndPng) {
  const fs::path folder = test::scratch_dir();
  draw_plots(two_panels(), folder / "plot_a.svg");
  const std::string svg = content(folder / "plot_a.svg");
  for (const char* text : {"</svg>", "grid_26", "error \"against\" time", "CPU time (s)", "a remark"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  draw_plots(two_panels(), folder / "plot_a.png");
  EXPECT_EQ(content(folder / "plot_a.png").substr(1, 3), "PNG");
  for (const auto& entry : fs::directory_iterator(folder))  // nothing half-made stays behind
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
}

TEST(Plot, RefusesWhatItCannotDraw) {
  const fs::path folder = test::scratch_dir();
  EXPECT_THROW(draw_plots(two_panels(), folder / "plot_a.gif"), Error);
  EXPECT_THROW(draw_plots({}, folder / "b.svg"), Error);
  PlotPage uneven = two_panels();
  uneven.panels[0].series[0].y.pop_back();
  EXPECT_THROW(draw_plots(uneven, folder / "b.svg"), Error);
  EXPECT_FALSE(fs::exists(folder / "b.svg"));
}

}  // namespace
}  // namespace sunfleck
