#include "tests/lighting/envelope/scenes.h"

namespace sunfleck::test {

FoliageElement square_leaf(const Vec3& centre_m, const Vec3& normal, double side_m) {
  const Basis basis = basis_around(glm::normalize(normal));
  FoliageElement e;
  e.centre_m = centre_m;
  e.half_u_m = 0.5 * side_m * basis.tangent;
  e.half_v_m = 0.5 * side_m * basis.bitangent;
  e.area_m2 = static_cast<float>(side_m * side_m);
  return e;
}

Forest forest_of(std::vector<FoliageElement> foliage) {
  Forest forest;
  forest.materials = {
      {"leaf", {{"VIS", 0.25, 0.25, 0.1}, {"PAR", 0.10, 0.05, 0.1}, {"NIR", 0.45, 0.45, 0.3}}}};
  Prototype& prototype = forest.prototypes.emplace_back();
  prototype.name = "test";
  prototype.materials = {"leaf"};
  prototype.foliage = std::move(foliage);
  forest.instances.push_back({});
  return forest;
}

Illumination light_of(const Vec3& to_sun, double beam_w_m2, double diffuse_w_m2, std::size_t bands) {
  Illumination light;
  light.to_sun = to_sun;
  light.bands.assign(bands, {.beam_normal_w_m2 = beam_w_m2, .diffuse_horizontal_w_m2 = diffuse_w_m2});
  return light;
}

OpticsTable optics_of(const Forest& forest, std::vector<std::string> bands, double soil_albedo) {
  OpticsRequest request;
  request.soil_albedo.assign(bands.size(), soil_albedo);
  request.bands = std::move(bands);
  return OpticsTable(forest, request);
}

LightMap envelope_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                      EnvelopeSun sun) {
  return envelope_light_map(forest, optics, light, {.sun = sun, .cell_m = 0}, {});
}

LightMap envelope_full_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                           const EnvelopeFullOptions& options) {
  return envelope_full_light_map(forest, optics, light, options, {});
}

namespace {
// All elements of the test scenes have the same area: a plain mean.
double mean_part(const LightMap& map, float FaceLight::*part) {
  double sum = 0.0;
  for (const ElementLight& e : map.bands.at(0).elements)
    sum += static_cast<double>(e.front.*part) + e.back.*part;
  return sum / static_cast<double>(map.bands[0].elements.size());
}
}  // namespace

double mean_direct(const LightMap& map) { return mean_part(map, &FaceLight::direct_w_m2); }
double mean_sky(const LightMap& map) { return mean_part(map, &FaceLight::sky_w_m2); }
double mean_scattered(const LightMap& map) { return mean_part(map, &FaceLight::scattered_w_m2); }

}  // namespace sunfleck::test
