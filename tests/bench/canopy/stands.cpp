// Measured stands. canopy_stands [cloture20] [leaves per tree]: a season at the measured sensors.
// canopy_stands <stand> <leaves per tree> <rays per cell, or 0 for the default>: absorbed PAR per tree
// against the reference.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include "lighting/canopy/stand_light.h"
#include "lighting/trace/reference.h"
#include "sim/base/parallel.h"
#include "tests/bench/canopy/measured_stand.h"
#include "tests/bench/canopy/season.h"

namespace sunfleck::bench {
namespace {

const std::filesystem::path kStands = std::filesystem::path(SUNFLECK_SOURCE_DIR) / "../shared/data/stands";
std::filesystem::path stands() {
  if (std::filesystem::exists(kStands)) return kStands;
  const char* given = std::getenv("SUNFLECK_SHARED_DATA");
  return std::filesystem::path(given ? given : ".") / "stands";
}

class Lap {
 public:
  void print(const char* what) {
    std::printf("  %-22s wall %6.3f s  cpu %6.3f s\n", what, wall() - wall_, cpu() - cpu_);
    wall_ = wall();
    cpu_ = cpu();
  }

 private:
  static double wall() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  static double cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
  double wall_ = wall(), cpu_ = cpu();
};

void print_sensors(const MeasuredStand& stand, const StandLight& light, bool each) {
  const SensorTables& s = light.sensors;
  for (std::size_t i = 0; each && i < stand.sensors.size(); ++i)
    std::printf("    sensor %-3s measured %.2f (%.2f %.2f)  ours %.3f (%.3f %.3f) +- %.3f\n",
                stand.sensors[i].name.c_str(), stand.pacl[i], stand.pacl_direct[i], stand.pacl_diffuse[i],
                s.gap_light_index[i], s.direct_site_factor[i], s.indirect_site_factor[i],
                s.pacl_total.error_at(0, i));
  const auto row = [](const char* what, const Agreement& a) {
    std::printf("    %-8s RMSE %.4f  bias %+.4f  correlation %.3f  spread %.3f\n", what, a.rmse, a.bias,
                a.correlation, a.spread);
  };
  row("total", agreement(s.gap_light_index, stand.pacl));
  row("direct", agreement(s.direct_site_factor, stand.pacl_direct));
  row("diffuse", agreement(s.indirect_site_factor, stand.pacl_diffuse));
}

void print_plot(const StandLight& light) {
  const PlotTables& p = light.plot;
  std::printf("    sent %.4g = leaves %.4g + wood %.4g + ground %.4g + beyond %.4g + missed %.4g\n",
              p.sent[0], p.leaves[0], p.wood[0], p.ground[0], p.beyond[0], p.missed[0]);
  for (const PlotBand& b : p.bands)
    std::printf(
        "    %s: fapar %.4f albedo %.4f transmittance %.4f; leaves %.4g wood %.4g ground %.4g reflected "
        "%.4g beyond %.4g\n",
        b.band.c_str(), b.fapar[0], b.albedo[0], b.transmittance[0], b.leaves[0], b.wood[0], b.ground[0],
        b.reflected[0], b.beyond[0]);
}

// 8,784 hours, half of them night: each with one sun bin and the whole sky.
void a_year_of_hours(const StandScene& scene, const OpticsTable& optics, const StandLightRequest& request) {
  Lap lap;
  const DirectionalBasis basis = prepare_stand_light(scene, optics, request, {});
  lap.print("basis");
  const WeightRows& sky = basis.sky.sky.strength;
  stand_light(scene, basis, basis.sky.sun.strength, sky, basis.sky.intervals, {});
  lap.print("7 months");
  WeightRows sun_hours, sky_hours;
  for (std::size_t hour = 0; hour < 8784; ++hour) {
    if (hour % 2 == 0) {
      sun_hours.add(hour / 2 % basis.sky.sun.size(), 1.0);
      for (std::size_t i = sky.row_begin[0]; i < sky.row_begin[1]; ++i)
        sky_hours.add(sky.column[i], sky.value[i]);
    }
    sun_hours.end_row();
    sky_hours.end_row();
  }
  stand_light(scene, basis, sun_hours, sky_hours, std::vector<std::string>(8784, "hour"), {});
  lap.print("8,784 hours");
}

void cloture20(int leaves) {
  for (const bool periodic : {true, false})
    for (const SkyModel model : {SkyModel::kUniform, SkyModel::kStandardOvercast}) {
      std::printf("cloture20, %s, %s\n", periodic ? "periodic" : "open", to_string(model).c_str());
      Lap lap;
      const MeasuredStand stand = measured_stand(stands() / "cloture20", leaves, periodic);
      lap.print("grow");
      StandSceneOptions options;
      options.map_lo_m = stand.map_lo_m;
      options.map_hi_m = stand.map_hi_m;
      const StandScene scene(stand.forest, options);
      lap.print("scene");
      SeasonOptions season;
      season.sky = model;
      StandLightRequest request;
      request.sky = season_sky(stands() / "cloture20/monthly_radiation.csv", season);
      request.sensors = stand.sensors;
      lap.print("season");
      const OpticsTable optics(stand.forest, {{"PAR"}, {0.1}, {}});
      const StandLight light = stand_light(scene, optics, request, {});
      lap.print("stand light");
      print_sensors(stand, light, periodic && model == SkyModel::kUniform);
      print_plot(light);
      if (periodic && model == SkyModel::kUniform) a_year_of_hours(scene, optics, request);
    }
}

// One sun and a uniform sky: per-tree absorbed PAR against the reference.
void against_reference(const std::string& name, int leaves, double rays_per_cell) {
  Lap lap;
  const MeasuredStand stand = measured_stand(stands() / name, leaves, true);
  lap.print("grow");
  const StandScene scene(stand.forest, {});
  lap.print("scene");
  SeasonOptions season;
  StandLightRequest request;
  StandSky all = season_sky(stands() / name / "monthly_radiation.csv", season);
  const Vec3 to_sun = direction_from_azimuth_zenith(2.9, radians_from_degrees(40.0));
  request.sky.sky.to_source = all.sky.to_source;
  request.sky.sky.half_angle_rad = all.sky.half_angle_rad;
  for (std::size_t d = 0; d < all.sky.size(); ++d)
    request.sky.sky.strength.add(d, 1.0 - std::cos(all.sky.half_angle_rad[d]));
  request.sky.sky.strength.end_row();
  const double open = open_energy(request.sky.sky, {0, 0, 1})[0];
  for (double& v : request.sky.sky.strength.value) v *= 90.0 / open;
  request.sky.sun.to_source = {to_sun};
  request.sky.sun.strength.add(0, 300.0 / to_sun.z);
  request.sky.sun.strength.end_row();
  request.sky.intervals = {"noon"};
  if (rays_per_cell > 0.0) {
    request.rays_per_cell = rays_per_cell;
    request.tree_relative_error = 0;
  }
  const OpticsTable optics(stand.forest, {{"PAR"}, {0.1}, {}});
  const StandLight light = stand_light(scene, optics, request, {});
  lap.print("stand light");
  print_plot(light);
  Illumination sun;
  sun.to_sun = to_sun;
  sun.bands = {{300.0 / to_sun.z, 90.0}};
  ReferenceOptions options;
  options.rays_per_face = 32;
  options.sun_rays_per_element = 48;
  const LightMap truth = reference_light_map(stand.forest, optics, sun, options, {});
  lap.print("reference");
  const EnergyBudget& b = truth.bands[0].budget;
  std::printf(
      "  reference: incident %.5g leaves %.5g wood %.5g ground %.5g escaped %.5g residual %.3g +- %.3g\n",
      b.incident_w, b.absorbed_foliage_w, b.absorbed_wood_w, b.absorbed_ground_w, b.escaped_w, b.residual_w,
      b.residual_standard_error_w);
  std::vector<double> off, noise;
  double ours = 0, theirs = 0;
  for (std::size_t i = 0; i < truth.bands[0].trees.size(); ++i) {
    const TreeLight& tree = truth.bands[0].trees[i];
    const double got = light.trees.absorbed[0].at(0, i);
    ours += got;
    theirs += tree.absorbed_w;
    off.push_back(std::abs(got / tree.absorbed_w - 1.0));
    noise.push_back(tree.absorbed_standard_error_w / tree.absorbed_w);
  }
  std::sort(off.begin(), off.end());
  std::sort(noise.begin(), noise.end());
  const auto at = [](const std::vector<double>& v, double q) {
    return 100.0 * v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))];
  };
  std::printf(
      "  absorbed %.5g, reference %.5g (%+.2f %%); per tree off by median %.2f %%, 95th %.2f %%, worst "
      "%.2f %%; reference's own error median %.2f 95th %.2f %%\n",
      ours, theirs, 100.0 * (ours / theirs - 1.0), at(off, 0.5), at(off, 0.95), at(off, 1.0), at(noise, 0.5),
      at(noise, 0.95));
}

}  // namespace
}  // namespace sunfleck::bench

int main(int argc, char** argv) {
  const std::string stand = argc > 1 ? argv[1] : "cloture20";
  const int leaves = argc > 2 ? std::stoi(argv[2]) : 1000;
  sunfleck::with_threads(0, [&] {
    if (argc > 3)
      sunfleck::bench::against_reference(stand, leaves, std::stod(argv[3]));
    else
      sunfleck::bench::cloture20(leaves);
  });
}
