// See season.h.
#include "tests/bench/canopy/season.h"

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "sim/forest/csv_table.h"

namespace sunfleck::bench {

namespace {

struct Month {
  double global_mj_m2 = 0, diffuse_fraction = 0;
};

std::map<int, Month> read_months(const std::filesystem::path& path) {
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const CsvTable table(text, path.string());
  std::map<int, Month> months;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const int month = static_cast<int>(table.number(r, table.required_column("month"), 1, 12, "1 to 12"));
    months[month] = {table.number(r, table.required_column("global_horizontal_mj_m2"), 0, 1e5, "MJ m-2"),
                     table.number(r, table.required_column("diffuse_fraction"), 0, 1, "0 to 1")};
  }
  return months;
}

using Bin = std::array<int, 2>;
struct BinLight {
  Vec3 weighted{0};
  std::map<int, double> horizontal;  // by month
};

std::map<Bin, BinLight> sun_bins(const SeasonOptions& o, const std::map<int, Month>& months) {
  constexpr std::array<int, 12> kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  constexpr int kStepsPerHour = 4;
  std::map<Bin, BinLight> bins;
  for (int month = o.first_month; month <= o.last_month; ++month) {
    std::vector<Vec3> suns;
    double sum = 0.0;
    for (int day = 1; day <= kDays[static_cast<std::size_t>(month - 1)]; ++day)
      for (int step = 0; step < 24 * kStepsPerHour; ++step) {
        const UtcTime time{o.year, month, day, step / kStepsPerHour, step % kStepsPerHour * 15, 450.0};
        const Vec3 sun = sun_position(o.place, time).to_sun();
        if (sun.z <= 0.0) continue;
        suns.push_back(sun);
        sum += sun.z;
      }
    const Month& m = months.at(month);
    for (const Vec3& sun : suns) {
      const double horizontal = m.global_mj_m2 * (1.0 - m.diffuse_fraction) * sun.z / sum;
      const Bin bin{static_cast<int>(degrees_from_radians(azimuth_of(sun)) / o.bin_deg),
                    static_cast<int>(degrees_from_radians(zenith_of(sun)) / o.bin_deg)};
      bins[bin].weighted += horizontal * sun;
      bins[bin].horizontal[month] += horizontal;
    }
  }
  return bins;
}

void add_sky(StandSky& sky, const SeasonOptions& o, const std::vector<double>& diffuse_mj_m2) {
  std::vector<double> share;  // strength for a diffuse irradiance of 1
  double sum = 0.0;
  const double d_z = 1.0 / o.sky_rings;
  for (int ring = 0; ring < o.sky_rings; ++ring) {
    const double z = 1.0 - (ring + 0.5) * d_z;
    const int count =
        std::max(4, static_cast<int>(std::lround(2.0 * kPi * std::sqrt(1.0 - z * z) / std::sqrt(0.5 * d_z))));
    for (int k = 0; k < count; ++k) {
      sky.sky.to_source.push_back(direction_from_azimuth_zenith(2.0 * kPi * (k + 0.5) / count, std::acos(z)));
      const double solid_angle = 2.0 * kPi * d_z / count;
      sky.sky.half_angle_rad.push_back(cone_half_angle_rad(solid_angle));
      share.push_back(relative_sky_radiance(o.sky, z) * solid_angle);
      sum += share.back() * z;
    }
  }
  for (const double diffuse : diffuse_mj_m2) {
    for (std::size_t d = 0; d < share.size(); ++d) sky.sky.strength.add(d, diffuse * share[d] / sum);
    sky.sky.strength.end_row();
  }
}

}  // namespace

StandSky season_sky(const std::filesystem::path& table, const SeasonOptions& o) {
  const auto months = read_months(table);
  const auto bins = sun_bins(o, months);
  StandSky sky;
  for (const auto& [bin, light] : bins) {
    sky.sun.to_source.push_back(glm::normalize(light.weighted));
    sky.sun.half_angle_rad.push_back(radians_from_degrees(0.56 * o.bin_deg));
  }
  std::vector<double> diffuse;
  const int rows = o.by_month ? o.last_month - o.first_month + 1 : 1;
  for (int row = 0; row < rows; ++row) {
    diffuse.push_back(0.0);
    sky.intervals.push_back(o.by_month ? std::to_string(o.first_month + row) : "season");
    std::size_t d = 0;
    for (const auto& [bin, light] : bins) {
      double horizontal = 0.0;
      for (const auto& [month, h] : light.horizontal)
        if (!o.by_month || month == o.first_month + row) horizontal += h;
      sky.sun.strength.add(d, horizontal / sky.sun.to_source[d].z);
      ++d;
    }
    sky.sun.strength.end_row();
    for (int month = o.first_month; month <= o.last_month; ++month)
      if (!o.by_month || month == o.first_month + row)
        diffuse.back() += months.at(month).global_mj_m2 * months.at(month).diffuse_fraction;
  }
  add_sky(sky, o, diffuse);
  return sky;
}

}  // namespace sunfleck::bench
