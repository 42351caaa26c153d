// Small scenes and one-line calls for the tests of the estimators.
#pragma once

#include <cmath>

#include "lighting/base/summaries.h"
#include "lighting/slab/spp_estimators.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck::test {

inline const std::vector<SppVariant> kVariants{SppVariant::kSingleScattering, SppVariant::kSpp,
                                               SppVariant::kSppG};

// With those that are meant for other scenes than the ones asked.
inline const std::vector<SppVariant> kAllVariants{SppVariant::kSingleScattering, SppVariant::kSpp,
                                                  SppVariant::kSppG, SppVariant::kSppH,
                                                  SppVariant::kSppMarched};

// Same leaf reflectance and transmittance on both faces, one band.
inline OpticsTable optics_of(const Forest& forest, double reflectance, double transmittance,
                             double soil_albedo = 0.0) {
  OpticsRequest request{{"TEST"}, {soil_albedo}, {}};
  request.overrides.push_back(
      {"*", "TEST", {{reflectance, reflectance, transmittance, transmittance}, reflectance}});
  return OpticsTable(forest, request);
}

inline Illumination light_of(const Vec3& to_sun, double beam_w_m2, double diffuse_w_m2,
                             SkyModel sky = SkyModel::kUniform) {
  Illumination light;
  light.to_sun = to_sun;
  light.sky = sky;
  light.bands = {{beam_w_m2, diffuse_w_m2}};
  return light;
}

inline Vec3 sun_at(double zenith_deg, double azimuth_deg = 40.0) {
  return direction_from_azimuth_zenith(radians_from_degrees(azimuth_deg), radians_from_degrees(zenith_deg));
}

inline LightMap estimate(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                         SppVariant variant) {
  SppOptions options;
  options.variant = variant;
  return spp_light_map(forest, optics, light, options, {});
}

inline double absorbed_w(const LightMap& map) {
  double sum = 0.0;
  for (const TreeLight& tree : map.bands[0].trees) sum += tree.absorbed_w;
  return sum;
}

// Largest difference of any part of any element, relative to the mean irradiance.
inline double largest_difference(const LightMap& a, const LightMap& b) {
  double worst = 0.0;
  for (std::size_t e = 0; e < a.bands[0].elements.size(); ++e) {
    const ElementLight &x = a.bands[0].elements[e], &y = b.bands[0].elements[e];
    const auto face = [&](const FaceLight& f, const FaceLight& g) {
      for (const float d :
           {f.direct_w_m2 - g.direct_w_m2, f.sky_w_m2 - g.sky_w_m2, f.scattered_w_m2 - g.scattered_w_m2})
        worst = std::max(worst, static_cast<double>(std::abs(d)));
    };
    face(x.front, y.front);
    face(x.back, y.back);
  }
  return worst / a.bands[0].mean_irradiance_w_m2;
}

inline FoliageElement square_leaf(const Vec3& centre, const Vec3& half_u, const Vec3& half_v) {
  FoliageElement e;
  e.centre_m = Vec3f(centre);
  e.half_u_m = Vec3f(half_u);
  e.half_v_m = Vec3f(half_v);
  e.area_m2 = static_cast<float>(4.0 * glm::length(glm::cross(half_u, half_v)));
  return e;
}

// One tree at the origin that holds these elements.
inline Forest forest_of(std::vector<FoliageElement> elements) {
  Forest forest;
  forest.materials = {{"leaf", {}}};
  Prototype p;
  p.name = "tree";
  p.materials = {"leaf"};
  p.foliage = std::move(elements);
  forest.prototypes = {std::move(p)};
  forest.instances = {Instance{}};
  return forest;
}

}  // namespace sunfleck::test
