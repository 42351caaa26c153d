// Measured stands: canopy_stands [cloture20] [leaves per tree], canopy_stands bechefa [leaves] [rays per cell].
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <algorithm>
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
  std::printf("    sent %.4g = leaves %.4g + wood %.4g + ground %.4g + beyond %.4g + missed %.4g\n", p.sent[0],
              p.leaves[0], p.wood[0], p.ground[0], p.beyond[0], p.missed[0]);
  for (const PlotBand& b : p.bands)
    std::printf("    %s: fapar %.4f albedo %.4f transmittance %.4f; leaves %.4g wood %.4g ground %.4g reflected "
                "%.4g beyond %.4g\n",
                b.band.c_str(), b.fapar[0], b.albedo[0], b.transmittance[0], b.leaves[0], b.wood[0],
                b.ground[0], b.reflected[0], b.beyond[0]);
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
  for (std::size_t d = 0; d < all.sky.size(); ++d) request.sky.sky.strength.add(d, 1.0 - std::cos(all.sky.half_angle_rad[d]));
  request.sky.sky.strength.end_row();
  const double open = open_energy(request.sky.sky, {0, 0, 1})[0];
  for (double& v : request.sky.sky.strength.value) v *= 90.0 / open;
  request.sky.sun.to_source = {to_sun};
  request.sky.sun.strength.add(0, 300.0 / to_sun.z);
  request.sky.sun.strength.end_row();
  request.sky.intervals = {"noon"};
  request.rays_per_cell = rays_per_cell;
  const OpticsTable optics(stand.forest, {{"PAR"}, {0.1}, {}});
  const StandLight light = stand_light(scene, optics, request, {});
  lap.print("stand light");
  print_plot(light);
  {
    StandLightRequest r2 = request; r2.sky.sun.strength.value[0] = 0;
    const StandLight l2 = stand_light(scene, optics, r2, {});
    std::printf("sky only: leaves %g, sun only %g\n", l2.plot.leaves[0], light.plot.leaves[0] - l2.plot.leaves[0]);
  }
  Illumination sun;
  sun.to_sun = to_sun;
  sun.bands = {{300.0 / to_sun.z, 90.0}};
  ReferenceOptions options;
  options.rays_per_face = 8;
  options.sun_rays_per_element = 8;
  const LightMap truth = reference_light_map(stand.forest, optics, sun, options, {});
  lap.print("reference");
  const EnergyBudget& b = truth.bands[0].budget;
  std::printf("  reference: incident %.5g leaves %.5g wood %.5g ground %.5g escaped %.5g residual %.3g +- %.3g\n",
              b.incident_w, b.absorbed_foliage_w, b.absorbed_wood_w, b.absorbed_ground_w, b.escaped_w,
              b.residual_w, b.residual_standard_error_w);
  std::vector<double> off, noise;
  double ours = 0, theirs = 0, a[2] = {}, bb[2] = {};
  for (std::size_t i = 0; i < truth.bands[0].trees.size(); ++i) {
    const TreeLight& tree = truth.bands[0].trees[i];
    const double got = light.trees.absorbed[0].at(0, i);
    ours += got;
    const bool sh = stand.forest.prototypes[i].foliage[0].shape == ElementShape::kShoot; a[sh] += got; bb[sh] += tree.absorbed_w;
    theirs += tree.absorbed_w;
    off.push_back(std::abs(got / tree.absorbed_w - 1.0));
    noise.push_back(tree.absorbed_standard_error_w / tree.absorbed_w);
  }
  std::printf("flat %g shoots %g\n", a[0] / bb[0], a[1] / bb[1]);
  const ForestIndex index(stand.forest);
  double sun_e = 0, sky_e = 0;
  for (std::size_t e = 0; e < truth.bands[0].elements.size(); ++e) {
    const auto& l = truth.bands[0].elements[e];
    const double area = world_element(stand.forest, index.place(e).instance, index.place(e).local).area_m2;
    sun_e += area * (l.front.direct_w_m2 + l.back.direct_w_m2);
    sky_e += area * (l.front.sky_w_m2 + l.back.sky_w_m2);
  }
  std::printf("reference direct %g sky %g\n", sun_e, sky_e);
  std::sort(off.begin(), off.end());
  std::sort(noise.begin(), noise.end());
  const auto at = [](const std::vector<double>& v, double q) {
    return 100.0 * v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))];
  };
  std::printf("  absorbed %.5g, reference %.5g (%+.2f %%); per tree off by median %.2f %%, 95th %.2f %%, worst "
              "%.2f %%; reference's own error median %.2f 95th %.2f %%\n",
              ours, theirs, 100.0 * (ours / theirs - 1.0), at(off, 0.5), at(off, 0.95), at(off, 1.0),
              at(noise, 0.5), at(noise, 0.95));
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
