// Every table of a stand study by its name on the wire, once for both directions: `Visit` either collects
// views of the numbers or puts numbers that arrived in their place. For server/convert only.
//
// Visit has
//   table(name, IntervalTable&)                       float32 [interval][target], and its standard errors
//   numbers(name, std::vector<double>&)               float64
//   columns(name, {{column, &std::vector<double>}..}) float64 [row][column]; all equally long
// (const where it only looks).
#pragma once

#include <string>

#include "lighting/study/stand_study.h"

namespace sunfleck {

template <class Sensors, class Visit>
void visit_sensors(const std::string& begin, Sensors& sensors, Visit& visit) {
  visit.table(begin + "sensor_direct_mj_m2", sensors.direct);
  visit.table(begin + "sensor_diffuse_mj_m2", sensors.diffuse);
  visit.table(begin + "sensor_total_mj_m2", sensors.total);
  visit.table(begin + "sensor_open_direct_mj_m2", sensors.open_direct);
  visit.table(begin + "sensor_open_diffuse_mj_m2", sensors.open_diffuse);
  visit.table(begin + "sensor_pacl_direct", sensors.pacl_direct);
  visit.table(begin + "sensor_pacl_diffuse", sensors.pacl_diffuse);
  visit.table(begin + "sensor_pacl_total", sensors.pacl_total);
  visit.columns(begin + "sensor_site_factors", {{"direct_site_factor", &sensors.direct_site_factor},
                                                {"indirect_site_factor", &sensors.indirect_site_factor},
                                                {"gap_light_index", &sensors.gap_light_index}});
}

template <class Plot, class Visit>
void visit_plot(const std::string& begin, Plot& plot, Visit& visit) {
  visit.columns(begin + "plot_mj", {{"on_map_mj", &plot.on_map},
                                    {"sent_mj", &plot.sent},
                                    {"leaves_mj", &plot.leaves},
                                    {"wood_mj", &plot.wood},
                                    {"ground_mj", &plot.ground},
                                    {"beyond_mj", &plot.beyond},
                                    {"missed_mj", &plot.missed}});
  for (auto& band : plot.bands)
    visit.columns(begin + band.band + "/plot", {{"leaves_mj", &band.leaves},
                                                {"wood_mj", &band.wood},
                                                {"ground_mj", &band.ground},
                                                {"reflected_mj", &band.reflected},
                                                {"beyond_mj", &band.beyond},
                                                {"ground_scattered_mj", &band.ground_scattered},
                                                {"fapar", &band.fapar},
                                                {"albedo", &band.albedo},
                                                {"transmittance", &band.transmittance}});
}

// Everything that differs from interval to interval. Band tables: as many as plot.bands, whose names are set.
template <class Light, class Visit>
void visit_intervals(const std::string& begin, Light& light, Visit& visit) {
  visit_sensors(begin, light.sensors, visit);
  visit.table(begin + "ground_direct_share", light.ground.direct_share);
  visit.table(begin + "ground_diffuse_share", light.ground.diffuse_share);
  visit.table(begin + "ground_total_mj_m2", light.ground.total);
  visit.table(begin + "tree_intercepted_mj", light.trees.intercepted);
  visit.table(begin + "tree_potential_mj", light.trees.potential);
  visit.table(begin + "tree_sunlit_leaf_area_m2", light.trees.sunlit_leaf_area_m2);
  visit.table(begin + "tree_light_competition", light.trees.light_competition);
  visit.table(begin + "layer_intercepted_mj", light.layers.intercepted);
  visit.table(begin + "layer_sunlit_leaf_area_m2", light.layers.sunlit_leaf_area_m2);
  visit.table(begin + "level_light_share", light.layers.light_share);
  for (std::size_t b = 0; b < light.plot.bands.size(); ++b) {
    const std::string band = begin + light.plot.bands[b].band + "/";
    visit.table(band + "ground_scattered_mj_m2", light.ground.scattered[b]);
    visit.table(band + "tree_absorbed_mj", light.trees.absorbed[b]);
    visit.table(band + "layer_absorbed_mj", light.layers.absorbed[b]);
  }
  visit_plot(begin, light.plot, visit);
}

// The same for all intervals of a study by rays.
template <class Light, class Visit>
void visit_stand(Light& light, Visit& visit) {
  visit.numbers("tree_leaf_area_m2", light.tree_leaf_area_m2);
  visit.numbers("layer_leaf_area_m2", light.layers.leaf_area_m2);
  visit.columns("leaf_projection",
                {{"zenith_deg", &light.plot.zenith_deg}, {"leaf_projection", &light.plot.leaf_projection}});
}

template <class World, class Visit>
void visit_world(World& world, Visit& visit) {
  visit.table("world/ground_direct_share", world.ground_direct_share);
  visit.table("world/ground_diffuse_share", world.ground_diffuse_share);
  visit.table("world/ground_total_mj_m2", world.ground_total);
  visit.table("world/tree_intercepted_mj", world.tree_intercepted);
  visit.table("world/tree_potential_mj", world.tree_potential);
  visit.table("world/tree_light_competition", world.light_competition);
  visit.columns("world/plot_mj",
                {{"incident_mj", &world.incident}, {"trees_mj", &world.trees}, {"ground_mj", &world.ground}});
}

}  // namespace sunfleck
