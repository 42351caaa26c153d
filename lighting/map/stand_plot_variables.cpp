// Plot, height and angle tables of a study.
#include "lighting/map/stand_variables.h"

namespace sunfleck::stand {
namespace {

// Numbers per interval without errors: the period's first, then the parts'.
template <class Pick>
void add_series(const StandStudy& study, StandVariable variable, double factor, const Pick& pick,
                StandTable& table) {
  for (const std::optional<StandLight>* light : {&study.period, &study.parts})
    if (*light)
      for (const double v : pick((*light)->plot)) variable.value.push_back(factor * v);
  table.variables.push_back(std::move(variable));
}

void add_open_light(const StandStudy& study, StandTable& table) {
  StandVariable direct{"open_direct", "MJ m-2", "mj_m2", "direct global radiation on level open ground"};
  direct.value = study.direct_horizontal_mj_m2;
  StandVariable diffuse{"open_diffuse", "MJ m-2", "mj_m2", "diffuse global radiation on level open ground"};
  diffuse.value = study.diffuse_horizontal_mj_m2;
  StandVariable global{"open_global", "MJ m-2", "mj_m2", "global radiation on level open ground",
                       "integral_wrt_time_of_surface_downwelling_shortwave_flux_in_air"};
  StandVariable photons{"open_par_photons", "mol m-2", "mol_m2", "photons of PAR on level open ground"};
  for (std::size_t i = 0; i < direct.value.size(); ++i) {
    global.value.push_back(direct.value[i] + diffuse.value[i]);
    photons.value.push_back(study.spec.par.par_umol_m2(global.value[i]));  // MJ -> J and umol -> mol cancel
  }
  for (StandVariable* v : {&direct, &diffuse, &global, &photons}) table.variables.push_back(std::move(*v));
}

void add_unscattered(const StandStudy& study, StandTable& table) {
  const auto add = [&](const char* name, const char* long_name, std::vector<double> PlotTables::*member) {
    add_series(
        study, {name, "MJ", "mj", long_name}, 1,
        [&](const PlotTables& p) -> const std::vector<double>& { return p.*member; }, table);
  };
  add("open_on_map", "global radiation that open ground of the map's size gets", &PlotTables::on_map);
  add("followed", "global radiation whose way through the stand was followed", &PlotTables::sent);
  add("intercepted_leaves", "of it, unscattered light that met leaves", &PlotTables::leaves);
  add("intercepted_wood", "of it, unscattered light that met stems and branches", &PlotTables::wood);
  add("reached_ground", "of it, unscattered light that met the map's ground", &PlotTables::ground);
  add("beyond", "of it, unscattered light that left the map", &PlotTables::beyond);
}

void add_band(const StandStudy& study, std::size_t b, StandTable& table) {
  const std::string& name = study.period->plot.bands[b].band;
  const std::string word = "_" + band_word(name);
  const bool par = name == "PAR";
  const auto add = [&](const std::string& what, const std::string& long_name, const char* standard_name,
                       std::vector<double> PlotBand::*member) {
    add_series(
        study, {what + word, "1", "", long_name + ", " + name, standard_name}, 1,
        [&](const PlotTables& p) -> const std::vector<double>& { return p.bands[b].*member; }, table);
  };
  add("absorbed_fraction", "share of the light on the map's area that leaves absorb (fAPAR)",
      par ? "fraction_of_surface_downwelling_photosynthetic_radiative_flux_absorbed_by_vegetation" : "",
      &PlotBand::fapar);
  add("albedo", "share of the light sent that goes back to the sky", "", &PlotBand::albedo);
  add("transmittance", "share of the light on the map's area that reaches its ground", "",
      &PlotBand::transmittance);
  const auto energy = [&](const char* what, const char* long_name, std::vector<double> PlotBand::*member) {
    add_series(
        study, {what + word, "MJ", "mj", std::string(long_name) + ", " + name},
        par ? study.spec.par.par_fraction : 1,
        [&](const PlotTables& p) -> const std::vector<double>& { return p.bands[b].*member; }, table);
  };
  energy("absorbed_leaves", "energy absorbed by leaves", &PlotBand::leaves);
  energy("absorbed_wood", "energy absorbed by stems and branches", &PlotBand::wood);
  energy("absorbed_ground", "energy absorbed by the map's ground", &PlotBand::ground);
  energy("reflected", "energy reflected to the sky", &PlotBand::reflected);
}

void add_world(const LargeStandLight& world, StandTable& table) {
  const auto add = [&](const char* name, const char* long_name, const std::vector<double>& parts) {
    StandVariable v{name, "MJ", "mj", long_name};
    double whole = 0;
    for (const double p : parts) whole += p;
    v.value.push_back(whole);
    if (parts.size() > 1) v.value.insert(v.value.end(), parts.begin(), parts.end());
    table.variables.push_back(std::move(v));
  };
  add("open_on_map", "global radiation that open ground of the map's size gets", world.incident);
  add("intercepted", "unscattered light that met trees", world.trees);
  add("reached_ground", "unscattered light that met the map's ground", world.ground);
}

}  // namespace

StandTable plot_table(const StandStudy& study) {
  StandTable table{StandTarget::kPlot, 1, {}};
  add_open_light(study, table);
  if (study.world) add_world(*study.world, table);
  if (!study.period) return table;
  StandVariable lai{"leaf_area_index", "1",  "", "one-sided leaf area per ground area of the map",
                    "leaf_area_index", false};
  lai.value = {study.period->plot.leaf_area_index};
  table.variables.push_back(std::move(lai));
  add_unscattered(study, table);
  for (std::size_t b = 0; b < study.period->plot.bands.size(); ++b) add_band(study, b, table);
  return table;
}

void count_own_trees(const StandStudy& study, const std::vector<std::size_t>& trees, StandTable& plot) {
  const double area_m2 = study.spec.plot_area_m2;
  const double map_m2 = study.period->map.cell_area_m2() * static_cast<double>(study.period->map.count());
  double leaf_m2 = 0;
  for (const std::size_t t : trees) leaf_m2 += study.period->tree_leaf_area_m2[t];
  for (StandVariable& v : plot.variables) {
    if (v.name == "leaf_area_index") {
      v.long_name = "one-sided leaf area of the inventory's trees per ground area of the plot";
      v.value = {leaf_m2 / area_m2};
    }
    for (std::size_t b = 0; b < study.period->plot.bands.size(); ++b) {
      if (v.name != "absorbed_fraction_" + band_word(study.period->plot.bands[b].band)) continue;
      v.long_name = "share of the light on the plot's area that the inventory's trees absorb, " +
                    study.period->plot.bands[b].band;
      v.value.clear();
      for (const std::optional<StandLight>* light : {&study.period, &study.parts})
        for (std::size_t i = 0; *light && i < (*light)->intervals.size(); ++i) {
          double taken = 0;
          for (const std::size_t t : trees) taken += (*light)->trees.absorbed[b].at(i, t);
          const double open = (*light)->plot.on_map[i] / map_m2 * area_m2;
          v.value.push_back(open > 0 ? taken / open : 0);
        }
    }
  }
}

StandTable angle_table(const StandStudy& study) {
  StandTable table{StandTarget::kAngle, 0, {}};
  if (!study.period) return table;
  table.rows = study.period->plot.zenith_deg.size();
  StandVariable g{"leaf_projection",
                  "1",
                  "",
                  "leaf area projected towards that zenith angle per leaf area (G)",
                  "",
                  false};
  g.value = study.period->plot.leaf_projection;
  table.variables.push_back(std::move(g));
  return table;
}

StandTable layer_table(const StandStudy& study, double ground_m2) {
  StandTable table{StandTarget::kLayer, 0, {}};
  if (!study.period) return table;
  const LayerTables& layers = study.period->layers;
  table.rows = layers.leaf_area_m2.size();
  StandVariable area{
      "leaf_area", "m2", "m2", "one-sided leaf area of all trees in the layer, virtual ones too", "", false};
  area.value = layers.leaf_area_m2;
  StandVariable density{"leaf_area_density",
                        "m2 m-3",
                        "m2_m3",
                        "leaf area of all trees per volume over the ground they stand on",
                        "",
                        false};
  for (const double a : layers.leaf_area_m2) density.value.push_back(a / (ground_m2 * layers.layer_m));
  table.variables = {std::move(area), std::move(density)};
  StandVariable taken{"intercepted", "MJ", "mj", "unscattered global radiation that met leaves or wood"};
  fill(source(study, [](const StandLight& l) -> const IntervalTable& { return l.layers.intercepted; }), {}, 1,
       Errors::kKeep, taken);
  StandVariable sunlit{"sunlit_leaf_area", "m2", "m2", "sunlit leaf area, mean over the direct light"};
  fill(
      source(study, [](const StandLight& l) -> const IntervalTable& { return l.layers.sunlit_leaf_area_m2; }),
      {}, 1, Errors::kKeep, sunlit);
  table.variables.push_back(std::move(taken));
  table.variables.push_back(std::move(sunlit));
  add_absorbed(
      study, {}, "the leaves of the layer",
      [](const StandLight& l) -> const std::vector<IntervalTable>& { return l.layers.absorbed; }, table);
  return table;
}

StandTable level_table(const StandStudy& study) {
  StandTable table{StandTarget::kLevel, 0, {}};
  if (!study.period) return table;
  table.rows = study.period->layers.light_share.targets;
  StandVariable share{"light_share", "1", "", "unscattered light through a level plane, share of open light"};
  fill(source(study, [](const StandLight& l) -> const IntervalTable& { return l.layers.light_share; }), {}, 1,
       Errors::kKeep, share);
  table.variables.push_back(std::move(share));
  return table;
}

}  // namespace sunfleck::stand
