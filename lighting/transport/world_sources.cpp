// What comes into the world grid from outside: sun, sky and lit ground. See world_solver.h.
#include <algorithm>
#include <cmath>

#include "lighting/depth/grid_march.h"
#include "lighting/transport/world_solver.h"
#include "sim/base/parallel.h"

namespace sunfleck::transport {

namespace {

// Depth over half a cell beyond which its middle says nothing of its mean.
constexpr float kThickest = 3.0f;

// Extinction along any direction, for the sun.
std::vector<float> extinction_towards_sun(const WorldScene& scene, const Vec3& to_sun,
                                          std::vector<float>& of_kind, const RunControl& control) {
  DirectionSet sun;
  sun.to_source = {to_sun, -to_sun};
  sun.solid_angle_sr = {2 * kPi, 2 * kPi};
  for (const WorldPrototype& p : scene.prototypes) {
    of_kind.push_back(leaf_cover(p, sun)[0]);
    of_kind.push_back(wood_cover(p, sun)[0]);
  }
  std::vector<float> extinction(scene.cells(), 0.0f);
  const auto per_volume = static_cast<float>(1.0 / std::pow(scene.layout.mean_cell_m(), 3));
  for_each_chunk(scene.cells(), 65536, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      for (std::uint32_t e = scene.first_entry[c]; e < scene.first_entry[c + 1]; ++e)
        extinction[c] += scene.entries[e].area_m2 * of_kind[scene.entries[e].kind] * per_volume;
  });
  return extinction;
}

void add_sun(const WorldScene& scene, const Forest& forest, const Vec3& to_sun, WorldSources& sources,
             const RunControl& control) {
  sources.sun_extinction_per_m = extinction_towards_sun(scene, to_sun, sources.sun_cover, control);
  sources.sun_ground.assign(scene.ground->count(), 0.0f);
  sources.sun_transmittance.assign(scene.cells(), 0.0f);
  if (scene.frame.ends_on_ground(to_sun)) return;
  sources.open_ground = glm::dot(to_sun, forest.terrain.normal());
  const Vec3 towards = scene.frame.field_direction(to_sun);
  const SweepPlan plan = plan_sweep(scene.layout, towards);
  std::vector<float> pass(scene.cells());
  const auto half_step = static_cast<float>(-0.5 * plan.step_m);
  for_each_chunk(scene.cells(), 65536, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      pass[c] = sources.sun_extinction_per_m[c] > 0.0f ? std::exp(half_step * sources.sun_extinction_per_m[c])
                                                       : 1.0f;
  });
  sweep_even(plan, pass, EvenInflow(1.0), sources.sun_transmittance, control);
  // From the middle of a cell to its mean along the ray: what a cell takes is then what its slab lets not
  // pass.
  for_each_chunk(scene.cells(), 65536, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const float x = std::min(kThickest, -half_step * sources.sun_extinction_per_m[c]);
      if (x > 1e-3f)
        sources.sun_transmittance[c] = std::min(1.0f, sources.sun_transmittance[c] * std::sinh(x) / x);
    }
  });
  for_each_chunk(scene.ground->count(), 16, control, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      const Vec3 p = scene.frame.field_from_world(scene.ground->world_point(g));
      sources.sun_ground[g] =
          static_cast<float>(sources.open_ground *
                             std::exp(-march_grid(scene.layout, sources.sun_extinction_per_m, p, towards)));
    }
  });
}

}  // namespace

WorldSources world_sources(const WorldScene& scene, const Forest& forest, const Illumination& light,
                           const RunControl& control) {
  WorldSources sources;
  sources.sectors = sky_sectors(scene.set, sky_radiance(light), forest.terrain.normal());
  if (std::ranges::any_of(light.bands, [](const BandLight& b) { return b.diffuse_horizontal_w_m2 > 0; })) {
    sources.sky.assign(scene.set.count() * scene.cells(), 0.0f);
    sources.sky_around.resize(scene.set.count());
    for_each_chunk(scene.set.count(), 1, control, {}, [&](std::size_t d, std::size_t) {
      if (sources.sectors.sky_radiance[d] > 0.0)
        sources.sky_around[d] =
            sweep_even(scene.plans[d], scene.transmittance_of(d), EvenInflow(sources.sectors.sky_radiance[d]),
                       scene.part_of(sources.sky, d), control);
    });
  }
  const bool beam =
      std::ranges::any_of(light.bands, [](const BandLight& b) { return b.beam_normal_w_m2 > 0; });
  if (beam && light.sun_is_up()) add_sun(scene, forest, light.to_sun, sources, control);
  return sources;
}

WorldInflow::WorldInflow(const WorldScene& scene, const SkySectors& sectors, std::size_t direction,
                         double diffuse_w_m2, std::span<const float> ground_radiance,
                         float open_ground_radiance)
    : scene_(scene),
      ground_(scene, sectors, direction, ground_radiance, open_ground_radiance),
      ground_radiance_(ground_radiance),
      below_(scene.ground_below[direction]),
      sky_(static_cast<float>(diffuse_w_m2 * sectors.sky_radiance[direction])),
      share_(static_cast<float>(sectors.ground_share[direction])),
      open_radiance_(open_ground_radiance) {}

float WorldInflow::radiance(const std::array<int, 3>& cell) const {
  if (share_ == 0.0f) return sky_;
  const auto [nx, ny, nz] = scene_.layout.cells;
  const bool just_below =
      cell[2] == -1 && cell[0] >= 0 && cell[0] < nx && cell[1] >= 0 && cell[1] < ny && !below_.empty();
  if (!just_below) return sky_ + ground_.radiance(cell);
  const std::int32_t hit = below_[static_cast<std::size_t>(cell[1]) * static_cast<std::size_t>(nx) +
                                  static_cast<std::size_t>(cell[0])];
  return sky_ + share_ * (hit == GroundMap::kOpen ? open_radiance_
                                                  : ground_radiance_[static_cast<std::size_t>(hit)]);
}

WorldGround world_ground(const WorldScene& scene, const WorldSources& sources, const BandLight& strength,
                         const std::vector<float>& radiance, const RunControl& control) {
  std::vector<double> outside(sources.sectors.sky_radiance);
  for (double& r : outside) r *= strength.diffuse_horizontal_w_m2;
  WorldGround ground{ground_irradiance(scene, sources.sectors, radiance, outside, control),
                     strength.diffuse_horizontal_w_m2 * sources.sectors.open_ground_irradiance};
  if (sources.sun_ground.empty()) return ground;
  for (std::size_t g = 0; g < ground.irradiance.size(); ++g)
    ground.irradiance[g] += static_cast<float>(strength.beam_normal_w_m2 * sources.sun_ground[g]);
  ground.open += strength.beam_normal_w_m2 * sources.open_ground;
  return ground;
}

std::vector<float> ground_radiance(const WorldGround& ground, double soil_albedo) {
  std::vector<float> radiance(ground.irradiance);
  for (float& r : radiance) r *= static_cast<float>(soil_albedo / kPi);
  return radiance;
}

}  // namespace sunfleck::transport
