// The [light] table of a scene file as a LightRequest.
#pragma once

#include "lighting/plan/light_request.h"
#include "sim/config/config_table.h"

namespace sunfleck {

// Keys (all others are refused):
//   method                                     one of method_names()
//   skip                                       "auto" or "never"
//   [light.sun]  zenith_deg, azimuth_deg       or latitude_deg, longitude_deg, time (with elevation_m, ...)
//                half_angle_deg
//   [light.sky]  model                         "uniform" or "standard_overcast"
//   [[light.bands]] name, soil_albedo, diffuse_horizontal_w_m2,
//                direct_horizontal_w_m2 or beam_normal_w_m2
//   [[light.optics]] material, band, leaf_reflectance, leaf_transmittance (or ..._front, ..._back),
//                bark_reflectance
//   [light.reference], [light.spp], [light.envelope], [light.grid]    knobs as in their option structs
//   [light.auto] tolerance or time_s, measure (auto_measure_names()), layer_m, layers
//   [light.probes] count, paths_per_face, sun_rays, seed   measure the error of the answer of any method
LightRequest read_light_request(const ConfigTable& table);

}  // namespace sunfleck
