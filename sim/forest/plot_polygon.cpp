#include "sim/forest/plot_polygon.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "sim/base/error.h"
#include "sim/forest/csv_table.h"

namespace sunfleck {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

double signed_area_m2(const std::vector<Vec2>& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)  // about the first corner: far-away places lose nothing
    twice += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return 0.5 * twice;
}

// Whether sides ab and cd have a point in common (ends included).
bool cross_each_other(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto side = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    const double s = cross(q - p, r - p);
    return s > 0 ? 1 : s < 0 ? -1 : 0;
  };
  const auto on = [&](const Vec2& p, const Vec2& q, const Vec2& r) {
    return side(p, q, r) == 0 && std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) &&
           std::min(p.y, q.y) <= r.y && r.y <= std::max(p.y, q.y);
  };
  if (side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)) return true;
  return on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b);
}

using CornerName = std::function<std::string(std::size_t corner)>;

void refuse_crossing(const std::vector<Vec2>& corners, const CornerName& where) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours share a corner
      if (!cross_each_other(corners[i], corners[i + 1], corners[j], corners[(j + 1) % n])) continue;
      throw_invalid(where(j), "the side that starts here crosses the one that starts at " + where(i),
                    "list the corners in their order around the plot");
    }
}

}  // namespace

PlotPolygon plot_polygon(std::vector<Vec2> corners, const std::string& name, const CornerName& where) {
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  if (corners.size() < 3)
    throw_invalid(name, "a plot needs three corners at least", "one row x,y per corner, around the plot");
  refuse_crossing(corners, where);
  const double area = signed_area_m2(corners);
  if (!(std::fabs(area) > 1e-6))
    throw_invalid(name, "the plot has no area", "corners around an area, in metres");
  if (area < 0) std::reverse(corners.begin(), corners.end());
  return {std::move(corners)};
}

PlotPolygon parse_plot_polygon(std::string_view csv, const std::string& name) {
  const CsvTable table(csv, name);
  const std::size_t x = table.required_column("x"), y = table.required_column("y");
  std::vector<Vec2> corners;
  for (std::size_t row = 0; row < table.rows(); ++row)
    corners.push_back(
        {table.number(row, x, -1e7, 1e7, "metres east"), table.number(row, y, -1e7, 1e7, "metres north")});
  return plot_polygon(std::move(corners), name, [&](std::size_t corner) { return table.where(corner); });
}

PlotPolygon read_plot_polygon(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path))
    throw Error(ErrorKind::kNotFound, path.string(), "cannot be read",
                "give a CSV file with columns x and y");
  const std::string csv{std::istreambuf_iterator<char>(in), {}};
  return parse_plot_polygon(csv, path.string());
}

PlotPolygon rectangle(const Vec2& lo_m, const Vec2& hi_m) {
  return {{lo_m, {hi_m.x, lo_m.y}, hi_m, {lo_m.x, hi_m.y}}};
}

double area_m2(const PlotPolygon& polygon) { return std::fabs(signed_area_m2(polygon.corners_m)); }

bool contains(const PlotPolygon& polygon, const Vec2& point_m) {
  bool inside = false;  // crossings of the ray towards +x
  const auto& c = polygon.corners_m;
  for (std::size_t i = 0, j = c.size() - 1; i < c.size(); j = i++) {
    if ((c[i].y > point_m.y) == (c[j].y > point_m.y)) continue;
    const double x = c[i].x + (point_m.y - c[i].y) / (c[j].y - c[i].y) * (c[j].x - c[i].x);
    if (point_m.x < x) inside = !inside;
  }
  return inside;
}

PlotBounds bounds(const PlotPolygon& polygon) {
  PlotBounds box{polygon.corners_m.front(), polygon.corners_m.front()};
  for (const Vec2& corner : polygon.corners_m) {
    box.lo_m = glm::min(box.lo_m, corner);
    box.hi_m = glm::max(box.hi_m, corner);
  }
  return box;
}

}  // namespace sunfleck
