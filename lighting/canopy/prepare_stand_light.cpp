// The first step of stand_light.h: rays.
#include <algorithm>
#include <cmath>

#include "lighting/canopy/stand_light.h"
#include "sim/base/error.h"
#include "sim/base/random.h"

namespace sunfleck {

namespace {

void check(const StandLightRequest& r) {
  if (!(r.rays_per_cell > 0.0 && r.rays_per_cell <= 1e7))
    throw_invalid("stand_light.rays_per_cell", std::to_string(r.rays_per_cell) + " is out of range",
                  "more than 0, at most 10,000,000");
  if (!(r.tree_relative_error >= 0.0 && r.tree_relative_error <= 1.0))
    throw_invalid("stand_light.tree_relative_error",
                  std::to_string(r.tree_relative_error) + " is out of range",
                  "0 to 1; 0 for exactly rays_per_cell");
  if (r.potential_rays < 1 || r.potential_rays > 10'000'000)
    throw_invalid("stand_light.potential_rays", std::to_string(r.potential_rays) + " is out of range",
                  "1 to 10,000,000");
  for (const int rays : {r.sensor_sun_rays, r.sensor_sky_rays})
    if (rays < 1 || rays > 100'000)
      throw_invalid("stand_light.sensor_rays", std::to_string(rays) + " is out of range", "1 to 100,000");
}

// Energy that each direction brings to the ground over all intervals.
std::vector<double> ground_energy(const LightSource& source, const StandGround& ground) {
  std::vector<double> energy = total_strength(source);
  for (std::size_t d = 0; d < energy.size(); ++d) energy[d] *= ground.facing(source.to_source[d]);
  return energy;
}

// 95th percentile over the trees that are asked about of the relative standard error of what they intercept
// in all intervals.
double tree_error(const DirectionalBasis& basis, const StandScene& scene) {
  const std::size_t trees = basis.from_sun.tree_intercepted_m2.targets;
  std::vector<double> value(trees), variance(trees), relative;
  const auto add = [&](const ResponseTable& table, const std::vector<double>& strength) {
    for (std::size_t d = 0; d < table.directions; ++d)
      for (std::size_t t = 0; t < trees; ++t) {
        value[t] += strength[d] * table.row(d)[t];
        variance[t] += strength[d] * strength[d] * table.quantum[d] * table.row(d)[t];
      }
  };
  add(basis.from_sun.tree_intercepted_m2, total_strength(basis.sky.sun));
  add(basis.from_sky.tree_intercepted_m2, total_strength(basis.sky.sky));
  for (std::size_t t = 0; t < trees; ++t)
    if (scene.is_asked(t)) relative.push_back(value[t] > 0.0 ? std::sqrt(variance[t]) / value[t] : 1.0);
  const auto last = static_cast<double>(relative.size() - 1);
  const auto place = relative.begin() + static_cast<std::ptrdiff_t>(0.95 * last);
  std::nth_element(relative.begin(), place, relative.end());
  return *place;
}

// Half of the rays by energy, half evenly over the directions that bring any.
std::vector<double> share_out(const std::vector<double>& energy, double total_energy, double directions,
                              double rays) {
  std::vector<double> out(energy.size(), 0.0);
  for (std::size_t d = 0; d < energy.size(); ++d)
    if (energy[d] > 0.0) out[d] = std::max(1.0, rays * 0.5 * (energy[d] / total_energy + 1.0 / directions));
  return out;
}

}  // namespace

DirectionalBasis prepare_stand_light(const StandScene& scene, const OpticsTable& optics,
                                     const StandLightRequest& request, const RunControl& control) {
  check(request);
  DirectionalBasis basis;
  basis.sky = checked(request.sky);
  basis.sensors = checked(request.sensors, scene);
  const auto sun = ground_energy(basis.sky.sun, scene.ground());
  const auto sky = ground_energy(basis.sky.sky, scene.ground());
  double total = 0.0, directions = 0.0;
  for (const auto* energies : {&sun, &sky})
    for (const double e : *energies) {
      total += e;
      directions += e > 0.0 ? 1.0 : 0.0;
    }
  double rays = request.rays_per_cell * static_cast<double>(scene.ground().count());
  const auto options = [&](const std::vector<double>& energy, std::uint64_t part) {
    return DropOptions{mix_seed(request.seed, part), share_out(energy, total, directions, rays)};
  };
  const auto drop = [&](bool bounces) {
    DropOptions from_sun = options(sun, 1), from_sky = options(sky, 2);
    from_sun.bounces = from_sky.bounces = bounces;
    basis.from_sun = drop_light(scene, optics, basis.sky.sun, from_sun, control);
    basis.from_sky = drop_light(scene, optics, basis.sky.sky, from_sky, control);
  };
  if (request.tree_relative_error > 0.0 && total > 0.0) {
    // A tenth of the rays tells how many it takes.
    rays *= 0.1;
    drop(false);
    const double off = tree_error(basis, scene) / request.tree_relative_error;
    rays *= std::clamp(off * off, 10.0, 1000.0);
  }
  drop(request.scattering);
  const auto potential = [&](const LightSource& source, const std::vector<double>& energy,
                             std::uint64_t part) {
    const std::vector<double> share = share_out(energy, total, directions, request.potential_rays);
    std::vector<int> whole;
    for (const double s : share) whole.push_back(static_cast<int>(std::lround(s)));
    return crown_potential(scene, source, whole, mix_seed(request.seed, part), control);
  };
  if (request.potential) {
    basis.potential_sun_m2 = potential(basis.sky.sun, sun, 5);
    basis.potential_sky_m2 = potential(basis.sky.sky, sky, 6);
  }
  basis.sensors_sun = sensor_response(scene, basis.sensors, basis.sky.sun, request.sensor_sun_rays,
                                      mix_seed(request.seed, 3), control);
  basis.sensors_sky = sensor_response(scene, basis.sensors, basis.sky.sky, request.sensor_sky_rays,
                                      mix_seed(request.seed, 4), control);
  if (request.canopy_views) basis.canopy = sensor_canopy(scene, basis.sensors, request.canopy, control);
  return basis;
}

StandLight stand_light(const StandScene& scene, const OpticsTable& optics, const StandLightRequest& request,
                       const RunControl& control) {
  const DirectionalBasis basis = prepare_stand_light(scene, optics, request, control);
  return stand_light(scene, basis, basis.sky.sun.strength, basis.sky.sky.strength, basis.sky.intervals,
                     control);
}

}  // namespace sunfleck
