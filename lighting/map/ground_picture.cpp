#include "lighting/map/ground_picture.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lighting/map/gnuplot.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

// Dark green to pale yellow, even in lightness (five stops of our own).
constexpr char kPalette[] =
    "set palette defined (0 '#10262b', 0.25 '#1d5b4f', 0.5 '#4f9153', 0.75 '#b3bf5b', 1 '#fff3b0')\n";

void write_cells(std::ostream& out, const StandGround& map, const std::vector<double>& value) {
  out << "$cells << EOD\n";
  for (std::size_t c = 0; c < map.count(); ++c) {
    const Vec2 centre = map.centre_m(c);
    out << centre.x << ' ' << centre.y << ' ';
    if (std::isfinite(value[c]))
      out << value[c] << '\n';
    else
      out << "NaN\n";
  }
  out << "EOD\n";
}

void write_marks(std::ostream& out, const char* block, const std::vector<MapMark>& marks) {
  out << block << " << EOD\n";
  for (const MapMark& m : marks)
    out << m.at_m.x << ' ' << m.at_m.y << ' ' << m.radius_m << ' '
        << gnuplot_quoted(m.label.empty() ? " " : m.label) << '\n';
  out << "EOD\n";
}

int height_px(const StandGround& map, int width_px) {
  const Vec2 size = map.size_m();
  const double plot = (width_px - 190.0) * size.y / size.x + 110;
  return static_cast<int>(std::clamp(plot, 240.0, 4000.0));
}

std::string script_of(const StandGround& map, const GroundPicture& p, const std::filesystem::path& picture) {
  const Vec2 hi = map.lo_m + map.size_m();
  std::ostringstream out;
  out.precision(10);
  out << "set terminal pngcairo noenhanced size " << p.width_px << ',' << height_px(map, p.width_px)
      << " font \"sans,11\"\nset output " << gnuplot_quoted(picture.string()) << "\nset encoding utf8\n"
      << kPalette << "set title " << gnuplot_quoted(p.title) << "\nset xlabel \"east (m)\"\n"
      << "set ylabel \"north (m)\"\nset cblabel " << gnuplot_quoted(p.value_label) << "\n"
      << "set style textbox opaque noborder fillcolor rgb '#ffffff' margins 0.4,0.2\nset size ratio -1\nset "
         "tics out nomirror\nset border 15\nunset key\n"
      << "set xrange [" << map.lo_m.x << ':' << hi.x << "]\nset yrange [" << map.lo_m.y << ':' << hi.y
      << "]\n";
  if (p.from < p.to) out << "set cbrange [" << p.from << ':' << p.to << "]\n";
  write_cells(out, map, p.value);
  write_marks(out, "$stems", p.stems);
  write_marks(out, "$sensors", p.sensors);
  out << "plot $cells using 1:2:3 with image";
  if (!p.stems.empty())
    out << ", $stems using 1:2:3 with circles fill transparent solid 0.15 border linecolor rgb '#ffffff'";
  if (!p.sensors.empty())
    out << ", $sensors using 1:2 with points pointtype 9 pointsize 1.3 linecolor rgb '#d1495b'"
        << ", $sensors using 1:2:4 with labels boxed offset 0.9,0.7 left font \",9\" textcolor rgb '#8c1c2b'";
  out << "\nset output\n";
  return out.str();
}

}  // namespace

void draw_ground(const StandGround& map, const GroundPicture& picture, const std::filesystem::path& path) {
  if (path.extension() != ".png")
    throw_invalid(path.string(), "maps are not drawn as '" + path.extension().string() + "'", ".png");
  if (picture.value.size() != map.count() || map.count() == 0)
    throw_invalid("ground picture '" + picture.title + "'",
                  "has " + std::to_string(picture.value.size()) + " values for " +
                      std::to_string(map.count()) + " cells",
                  "one value for every cell");
  draw_by_gnuplot(path, [&](const std::filesystem::path& file) { return script_of(map, picture, file); });
}

}  // namespace sunfleck
