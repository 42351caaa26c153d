// Sun, sky and all bounces in the world grid.
#pragma once

#include "lighting/transport/world_light.h"
#include "lighting/transport/world_scene.h"

namespace sunfleck::transport {

// What depends on the sun's direction and the shape of the sky, for strengths of 1.
struct WorldSources {
  SkySectors sectors;
  std::vector<float> sky;                      // [direction][cell]; empty: no diffuse light
  std::vector<std::vector<float>> sky_around;  // per direction, what goes around a repeating grid
  std::vector<float> sun_cover;                // of a kind: projected area over area
  std::vector<float> sun_extinction_per_m;     // empty: no sun
  std::vector<float> sun_transmittance;        // to every cell, mean along the ray in it
  std::vector<float> sun_ground;               // irradiance of ground cells
  double open_ground = 0;                      // of the open ground by the sun
};
WorldSources world_sources(const WorldScene& scene, const Forest& forest, const Illumination& light,
                           const RunControl& control);

// Radiance from outside the grid along one direction: sky and lit ground.
class WorldInflow final : public Inflow {
 public:
  WorldInflow(const WorldScene& scene, const SkySectors& sectors, std::size_t direction, double diffuse_w_m2,
              std::span<const float> ground_radiance, float open_ground_radiance);
  float radiance(const std::array<int, 3>& cell) const override;

 private:
  const WorldScene& scene_;
  const GroundInflow ground_;
  std::span<const float> ground_radiance_;
  const std::vector<std::int32_t>& below_;
  float sky_, share_, open_radiance_;
};

// Irradiance of every ground cell, W m-2, and of the open ground.
struct WorldGround {
  std::vector<float> irradiance;
  double open = 0;
};
// Over the ground: radiosity over pi.
std::vector<float> ground_radiance(const WorldGround& ground, double soil_albedo);

// Fills all but `band` and `kernels`, which must be there.
void solve_world_band(const WorldScene& scene, const Forest& forest, const WorldSources& sources,
                      const BandLight& strength, double soil_albedo, const WorldOptions& options,
                      WorldBand& band, const RunControl& control);

WorldGround world_ground(const WorldScene& scene, const WorldSources& sources, const BandLight& strength,
                         const std::vector<float>& radiance, const RunControl& control);

}  // namespace sunfleck::transport
