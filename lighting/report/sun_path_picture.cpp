#include "lighting/report/sun_path_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "lighting/map/gnuplot.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr int kStep_min = 5, kDay_min = 24 * 60;
constexpr std::array<const char*, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                 "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
// Warm from winter to summer; the equinoxes nearly coincide and share a colour.
constexpr std::array<const char*, 4> kColours = {"#ff9f1c", "#ff3b30", "#ff9f1c", "#2ec4ff"};

SunPath path_of_day(const Place& place, const CivilDate& date, int utc_offset_minutes) {
  SunPath path{date, {}};
  const double begin_s = day_begin_s(day_number(date), utc_offset_minutes);
  for (int minute = 0; minute <= kDay_min; minute += kStep_min) {
    const SunPosition sun = sun_position(place, begin_s + 60.0 * minute);
    if (sun.zenith_rad >= 0.5 * kPi) continue;
    path.points.push_back(
        {place_in_photograph(sun.azimuth_rad, sun.zenith_rad), minute % 60 == 0 ? minute / 60 % 24 : -1});
  }
  return path;
}

// Row by row from the top; beyond the horizon nothing is drawn.
void write_photograph(std::ostream& out, const HemisphericalPhotograph& photograph) {
  const int n = photograph.pixels;
  out << "$sky << EOD\n";
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      const double x = (2 * column + 1.0) / n - 1, y = 1 - (2 * row + 1.0) / n;
      if (x * x + y * y > 1) {
        out << x << ' ' << y << " NaN\n";
        continue;
      }
      const auto at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column);
      out << x << ' ' << y << ' ' << photograph.sky[at] << '\n';
    }
  out << "EOD\n";
}

// A gap where the sun was below the horizon in between (midnight sun around the clock has none).
void write_path(std::ostream& out, const SunPath& path, std::size_t number) {
  out << "$path" << number << " << EOD\n";
  const SunPath::Point* last = nullptr;
  for (const SunPath::Point& p : path.points) {
    if (last && glm::length(p.at - last->at) > 0.1) out << '\n';
    out << p.at.x << ' ' << p.at.y << '\n';
    last = &p;
  }
  out << "EOD\n$hours" << number << " << EOD\n";
  for (const SunPath::Point& p : path.points)
    if (p.hour >= 0) out << p.at.x << ' ' << p.at.y << ' ' << p.hour << '\n';
  out << "EOD\n";
}

// Zenith angles of 30, 60 and 90 degrees.
void write_rings(std::ostream& out) {
  out << "$rings << EOD\n";
  for (const double share : {1.0 / 3, 2.0 / 3, 1.0}) {
    for (int deg = 0; deg <= 360; deg += 3) {
      const Vec2 at = share * place_in_photograph(radians_from_degrees(deg), 0.5 * kPi);
      out << at.x << ' ' << at.y << '\n';
    }
    out << '\n';
  }
  out << "EOD\n";
}

bool has_hours(const SunPath& path) {
  return std::any_of(path.points.begin(), path.points.end(), [](const auto& p) { return p.hour >= 0; });
}

std::string name_of(const SunPath& path) {
  return std::to_string(path.date.day) + " " + kMonths[static_cast<std::size_t>(path.date.month - 1)];
}

std::string plots(const std::vector<SunPath>& paths) {
  std::ostringstream out;
  out << "plot $sky using 1:2:3 with image notitle, $rings using 1:2 with lines linewidth 0.7 linecolor rgb "
         "'#8892a0' notitle";
  for (std::size_t k = 0; k < paths.size(); ++k) {
    if (paths[k].points.empty()) continue;
    out << ", $path" << k << " using 1:2 with lines linewidth 2 linecolor rgb '" << kColours[k % 4]
        << "' title " << gnuplot_quoted(name_of(paths[k]));
    // The equinoxes nearly lie on each other: the first carries the hours of both.
    if (!has_hours(paths[k]) || k % 4 == 2) continue;
    out << ", $hours" << k << " using 1:2 with points pointtype 7 pointsize 0.7 linecolor rgb '"
        << kColours[k % 4] << "' notitle, $hours" << k
        << " using 1:2:3 with labels boxed offset 0,0.9 font \",9\" textcolor rgb '#20242c' notitle";
  }
  return out.str();
}

std::string script_of(const HemisphericalPhotograph& photograph, const std::vector<SunPath>& paths,
                      const std::string& title, const std::filesystem::path& picture) {
  const int edge_px = std::clamp(photograph.pixels + photograph.pixels / 5 + 60, 260, 9000);
  std::ostringstream out;
  out.precision(7);
  out << "set terminal pngcairo noenhanced size " << edge_px << ',' << edge_px + 40
      << " font \"sans,11\"\nset output " << gnuplot_quoted(picture.string())
      << "\nset encoding utf8\n"
         "set palette gray\nset cbrange [0:1]\nunset colorbox\nunset border\nunset tics\nset size ratio -1\n"
         "set margins 1,1,3,2\nset xrange [-1.12:1.12]\nset yrange [-1.12:1.12]\n"
         "set style textbox opaque noborder fillcolor rgb '#ffffff' margins 0.2,0.1\n"
         "set key horizontal outside bottom center samplen 2\nset title "
      << gnuplot_quoted(title) << "\n"
      << "set label \"N\" at 0,1.06 center\nset label \"S\" at 0,-1.06 center\nset label \"E\" at -1.06,0 "
         "center\n"
         "set label \"W\" at 1.06,0 center\n";
  write_photograph(out, photograph);
  write_rings(out);
  for (std::size_t k = 0; k < paths.size(); ++k) write_path(out, paths[k], k);
  out << plots(paths) << "\nset output\n";
  return out.str();
}

}  // namespace

Vec2 place_in_photograph(double azimuth_rad, double zenith_rad) {
  const double radius = zenith_rad / (0.5 * kPi);
  return {-radius * std::sin(azimuth_rad), radius * std::cos(azimuth_rad)};
}

std::vector<SunPath> sun_paths(const Place& place, int year, int utc_offset_minutes) {
  std::vector<SunPath> paths;
  for (const auto& [month, day] : {std::pair{3, 20}, {6, 21}, {9, 22}, {12, 21}})
    paths.push_back(path_of_day(place, {year, month, day}, utc_offset_minutes));
  return paths;
}

void draw_sun_paths(const HemisphericalPhotograph& photograph, const std::vector<SunPath>& paths,
                    const std::string& title, const std::filesystem::path& path) {
  if (path.extension() != ".png")
    throw_invalid(path.string(), "sun paths are not drawn as '" + path.extension().string() + "'", ".png");
  draw_by_gnuplot(
      path, [&](const std::filesystem::path& file) { return script_of(photograph, paths, title, file); });
}

}  // namespace sunfleck
