// Tree, sensor and ground tables of a study.
#include "lighting/map/stand_variables.h"

namespace sunfleck::stand {
namespace {

using Member = std::function<const IntervalTable&(const StandLight&)>;

void add(const StandStudy& study, const std::vector<std::size_t>& rows, StandVariable variable, double factor,
         Errors errors, const Member& member, StandTable& table) {
  fill(source(study, member), rows, factor, errors, variable);
  table.variables.push_back(std::move(variable));
}

// World light has parts only; with a single interval they are the period.
void add_world(const std::vector<std::size_t>& rows, StandVariable variable, double factor,
               const IntervalTable& parts, const IntervalTable& whole, StandTable& table) {
  fill({&whole, parts.intervals > 1 ? &parts : nullptr}, rows, factor, Errors::kNone, variable);
  table.variables.push_back(std::move(variable));
}

// Quotient of two variables; 0 where nothing comes in.
std::vector<double> quotient(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> q(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) q[i] = b[i] > 0 ? a[i] / b[i] : 0;
  return q;
}

const StandVariable kIntercepted{"intercepted", "MJ", "mj",
                                 "unscattered global radiation that met leaves or wood of the tree"};
const StandVariable kPotential{"potential", "MJ", "mj", "the same if the tree stood alone in the open"};
const StandVariable kCompetition{"light_competition", "1", "",
                                 "intercepted / potential; 1: no neighbour takes anything"};

StandTable world_trees(const LargeStandLight& world, const std::vector<std::size_t>& rows) {
  StandTable table{StandTarget::kTree, rows.size(), {}};
  const IntervalTable taken = whole_of(world.tree_intercepted), alone = whole_of(world.tree_potential);
  add_world(rows, kIntercepted, 1, world.tree_intercepted, taken, table);
  add_world(rows, kPotential, 1, world.tree_potential, alone, table);
  StandVariable competition = kCompetition;
  competition.value = quotient(table.variables[0].value, table.variables[1].value);
  table.variables.push_back(std::move(competition));
  return table;
}

// Share of open light, direct and diffuse together, from the total and `open`, per interval the energy that
// open ground of the map's size gets.
void add_pacl_total(const StandGround& map, const std::vector<double>& open, StandTable& table) {
  const double map_m2 = map.cell_area_m2() * static_cast<double>(map.count());
  const StandVariable& total = *table.find("total");
  StandVariable share{"pacl_total", "1", "", "share of the light that open ground gets (unscattered)"};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const double scale = open[i] > 0 ? map_m2 / open[i] : 0;
    for (std::size_t at = i * table.rows; at < (i + 1) * table.rows; ++at) {
      share.value.push_back(scale * total.value[at]);
      if (!total.standard_error.empty()) share.standard_error.push_back(scale * total.standard_error[at]);
    }
  }
  table.variables.push_back(std::move(share));
}

// The period's first, then the parts'.
std::vector<double> open_on_map(const StandStudy& study) {
  std::vector<double> open;
  if (study.world) {
    open.push_back(0);
    for (const double part : study.world->incident) open[0] += part;
    if (study.world->incident.size() > 1)
      open.insert(open.end(), study.world->incident.begin(), study.world->incident.end());
    return open;
  }
  open = study.period->plot.on_map;
  if (study.parts) open.insert(open.end(), study.parts->plot.on_map.begin(), study.parts->plot.on_map.end());
  return open;
}

StandTable world_ground(const StandStudy& study) {
  const LargeStandLight& world = *study.world;
  StandTable table{StandTarget::kGround, world.map.count(), {}};
  // Shares of the period: each interval counts with its open light; without parts, there is one interval.
  const auto weights = [&](const std::vector<double>& open) {
    return open.size() > 1 ? std::vector<double>(open.begin() + 1, open.end()) : open;
  };
  const IntervalTable direct = whole_of(world.ground_direct_share, weights(study.direct_horizontal_mj_m2));
  const IntervalTable diffuse = whole_of(world.ground_diffuse_share, weights(study.diffuse_horizontal_mj_m2));
  const IntervalTable total = whole_of(world.ground_total);
  add_world({}, {"pacl_direct", "1", "", "share of the open ground's direct light"}, 1,
            world.ground_direct_share, direct, table);
  add_world({}, {"pacl_diffuse", "1", "", "share of the open ground's diffuse light"}, 1,
            world.ground_diffuse_share, diffuse, table);
  add_world({}, {"total", "MJ m-2", "mj_m2", "unscattered global radiation on the ground, per area of map"},
            1, world.ground_total, total, table);
  add_pacl_total(world.map, open_on_map(study), table);
  return table;
}

void add_measured(const StandStudy& study, StandTable& table) {
  const auto column = [&](const char* name, const char* what, std::optional<double> SensorRow::*member) {
    StandVariable v{name, "1", "", std::string("measured share of above-canopy ") + what, "", false};
    bool any = false;
    for (const SensorRow& row : study.spec.sensors) {
      v.value.push_back((row.*member).value_or(kNotKnown));
      any = any || (row.*member).has_value();
    }
    if (any) table.variables.push_back(std::move(v));
  };
  column("measured_pacl", "light", &SensorRow::pacl);
  column("measured_pacl_direct", "direct light", &SensorRow::pacl_direct);
  column("measured_pacl_diffuse", "diffuse light", &SensorRow::pacl_diffuse);
}

void add_canopy_views(const std::vector<SensorCanopy>& canopy, StandTable& table) {
  using Value = std::function<double(const SensorCanopy&)>;
  const auto column = [&](const char* name, const char* long_name, const Value& value, const Value& error) {
    StandVariable v{name, "1", "", long_name, "", false};
    for (const SensorCanopy& c : canopy) {
      v.value.push_back(value(c));
      if (error) v.standard_error.push_back(error(c));
    }
    table.variables.push_back(std::move(v));
  };
  using C = const SensorCanopy&;
  column(
      "openness", "share of the hemisphere's solid angle that is sky", [](C c) { return c.openness; },
      [](C c) { return c.openness_error; });
  column(
      "sky_view_factor", "the same weighted by the cosine to the zenith",
      [](C c) { return c.sky_view_factor; }, [](C c) { return c.sky_view_factor_error; });
  column(
      "effective_plant_area_index", "plant area per ground area from the gaps in five rings, as if random",
      [](C c) { return c.effective_lai_lai2000; }, [](C c) { return c.effective_lai_error; });
  column(
      "effective_plant_area_index_10_deg", "the same from rings of 10 degrees up to 80",
      [](C c) { return c.effective_lai_10_deg; }, nullptr);
  column(
      "plant_area_index", "plant area per ground area from the logarithms of the gaps (Lang and Xiang)",
      [](C c) { return c.clumped_lai; }, nullptr);
  column(
      "clumping", "effective plant area index / plant area index", [](C c) { return c.clumping; }, nullptr);
  StandVariable gaps{"gap_fraction", "1", "", "share of sky in rings of 10 degrees from the zenith", "",
                     false,          9};
  for (const SensorCanopy& c : canopy)
    for (const GapRing& ring : c.rings_10_deg) {
      gaps.value.push_back(ring.gap_fraction);
      gaps.standard_error.push_back(ring.standard_error);
    }
  table.variables.push_back(std::move(gaps));
}

void add_site_factors(const SensorTables& sensors, StandTable& table) {
  const auto column = [&](const char* name, const char* long_name, const std::vector<double>& values) {
    StandVariable v{name, "1", "", long_name, "", false};
    v.value = values;
    table.variables.push_back(std::move(v));
  };
  column("direct_site_factor", "share of the period's direct light", sensors.direct_site_factor);
  column("indirect_site_factor", "share of the period's diffuse light", sensors.indirect_site_factor);
  column("gap_light_index", "share of the period's light (GLI)", sensors.gap_light_index);
}

}  // namespace

StandTable tree_table(const StandStudy& study, const std::vector<std::size_t>& rows) {
  if (study.world) return world_trees(*study.world, rows);
  StandTable table{StandTarget::kTree, rows.size(), {}};
  const auto keep = Errors::kKeep;
  add(
      study, rows, kIntercepted, 1, keep, [](auto& l) -> auto& { return l.trees.intercepted; }, table);
  add(
      study, rows, kPotential, 1, keep, [](auto& l) -> auto& { return l.trees.potential; }, table);
  add(
      study, rows, kCompetition, 1, keep, [](auto& l) -> auto& { return l.trees.light_competition; }, table);
  add(
      study, rows, {"sunlit_leaf_area", "m2", "m2", "sunlit leaf area, mean over the direct light"}, 1, keep,
      [](auto& l) -> auto& { return l.trees.sunlit_leaf_area_m2; }, table);
  add_absorbed(
      study, rows, "the tree's leaves",
      [](const StandLight& l) -> const std::vector<IntervalTable>& { return l.trees.absorbed; }, table);
  return table;
}

StandTable sensor_table(const StandStudy& study) {
  StandTable table{StandTarget::kSensor, study.period ? study.spec.sensors.size() : 0, {}};
  if (table.rows == 0) return table;
  const ParFactors& par = study.spec.par;
  const double mol_per_mj = par.par_fraction * par.umol_per_j;
  const auto share = [&](const char* name, const char* what, const Member& member) {
    add(study, {}, {name, "1", "", std::string("share of above-canopy ") + what}, 1, Errors::kKeep, member,
        table);
  };
  const auto energy = [&](const char* name, const char* what, Errors errors, const Member& member) {
    add(study, {}, {name, "MJ m-2", "mj_m2", std::string("global radiation on the sensor, ") + what}, 1,
        errors, member, table);
  };
  add_measured(study, table);
  share(
      "pacl_total", "light", [](auto& l) -> auto& { return l.sensors.pacl_total; });
  share(
      "pacl_direct", "direct light", [](auto& l) -> auto& { return l.sensors.pacl_direct; });
  share(
      "pacl_diffuse", "diffuse light", [](auto& l) -> auto& { return l.sensors.pacl_diffuse; });
  energy(
      "direct", "direct", Errors::kKeep, [](auto& l) -> auto& { return l.sensors.direct; });
  energy(
      "diffuse", "diffuse", Errors::kKeep, [](auto& l) -> auto& { return l.sensors.diffuse; });
  energy(
      "total", "direct and diffuse", Errors::kKeep, [](auto& l) -> auto& { return l.sensors.total; });
  energy(
      "open_direct", "direct, nothing in the way", Errors::kNone,
      [](auto& l) -> auto& { return l.sensors.open_direct; });
  energy(
      "open_diffuse", "diffuse, nothing in the way", Errors::kNone,
      [](auto& l) -> auto& { return l.sensors.open_diffuse; });
  add(
      study, {}, {"par_photons", "mol m-2", "mol_m2", "photons of PAR on the sensor, unscattered"},
      mol_per_mj, Errors::kKeep, [](auto& l) -> auto& { return l.sensors.total; }, table);
  add_site_factors(study.period->sensors, table);
  if (!study.period->canopy.empty()) add_canopy_views(study.period->canopy, table);
  return table;
}

StandTable ground_table(const StandStudy& study) {
  if (study.world) return world_ground(study);
  StandTable table{StandTarget::kGround, study.period->map.count(), {}};
  const ParFactors& par = study.spec.par;
  const double mol_per_mj = par.par_fraction * par.umol_per_j;
  const auto keep = Errors::kKeep;
  add(
      study, {}, {"pacl_direct", "1", "", "share of the open ground's direct light"}, 1, keep,
      [](auto& l) -> auto& { return l.ground.direct_share; }, table);
  add(
      study, {}, {"pacl_diffuse", "1", "", "share of the open ground's diffuse light"}, 1, keep,
      [](auto& l) -> auto& { return l.ground.diffuse_share; }, table);
  add(
      study, {}, {"total", "MJ m-2", "mj_m2", "unscattered global radiation on the ground, per area of map"},
      1, keep, [](auto& l) -> auto& { return l.ground.total; }, table);
  add_pacl_total(study.period->map, open_on_map(study), table);
  add(
      study, {}, {"par_photons", "mol m-2", "mol_m2", "photons of PAR on the ground, unscattered"},
      mol_per_mj, keep, [](auto& l) -> auto& { return l.ground.total; }, table);
  for (std::size_t b = 0; b < study.period->ground.scattered.size(); ++b) {
    const std::string& band = study.spec.optics.bands[b];
    add(
        study, {},
        {"scattered_" + band_word(band), "MJ m-2", "mj_m2", "scattered light on the ground, " + band},
        band == "PAR" ? par.par_fraction : 1, keep, [b](auto& l) -> auto& { return l.ground.scattered[b]; },
        table);
  }
  return table;
}

}  // namespace sunfleck::stand
