// The outline of an inventoried area: a simple polygon in the plane, metres.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

struct PlotPolygon {
  std::vector<Vec2> corners_m;  // counter-clockwise, not repeated; at least 3
};

// Columns x, y (m); the last corner may repeat the first. Throws Error(kInvalidInput): fewer than three
// corners, sides that cross (names the lines), no area.
PlotPolygon read_plot_polygon(const std::filesystem::path& path);
PlotPolygon parse_plot_polygon(std::string_view csv, const std::string& name);
// The same for corners from elsewhere, in either direction of turning; `where` names a corner in messages.
PlotPolygon plot_polygon(std::vector<Vec2> corners_m, const std::string& name,
                         const std::function<std::string(std::size_t corner)>& where);
PlotPolygon rectangle(const Vec2& lo_m, const Vec2& hi_m);

double area_m2(const PlotPolygon& polygon);
bool contains(const PlotPolygon& polygon, const Vec2& point_m);
struct PlotBounds {
  Vec2 lo_m, hi_m;
};
PlotBounds bounds(const PlotPolygon& polygon);

}  // namespace sunfleck
