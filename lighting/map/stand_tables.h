// A stand study as plain tables: every number that goes to files and pages, with its name, units and error.
// NetCDF, CSV and the report are written from here, so that they hold the same numbers.
//
// Interval 0 is the whole period; the months, days or hours asked for follow. Energies are of global
// radiation unless their name says par (photosynthetically active radiation): par = par_fraction * global,
// and mol = MJ of par * umol_per_j. Bands other than PAR are given as if all of the global radiation were
// theirs. Trees of virtual surroundings are left out unless asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lighting/study/stand_study.h"

namespace sunfleck {

enum class StandTarget { kPlot, kTree, kSensor, kGround, kLayer, kLevel, kAngle };
std::string to_string(StandTarget target);  // "plot", "tree", ...

struct StandVariable {
  std::string name;       // "intercepted"; in files "<target>_intercepted"
  std::string units;      // as CF (udunits) writes them: "MJ m-2", "1"
  std::string unit_word;  // as column names do: "mj_m2"; empty for shares and counts
  std::string long_name;
  std::string standard_name = {};  // of the CF table, where it has one
  bool per_interval = true;
  int rings = 0;                            // above 0: one value per zenith ring as well, innermost
  std::vector<double> value = {};           // [interval][target], [target] or [target][ring]; NaN: not known
  std::vector<double> standard_error = {};  // the same, or empty where there is none

  std::string column() const { return unit_word.empty() ? name : name + "_" + unit_word; }
};

struct StandTable {
  StandTarget target = StandTarget::kPlot;
  std::size_t rows = 1;  // targets
  std::vector<StandVariable> variables;

  const StandVariable* find(const std::string& name) const;  // nullptr: not there
};

struct TreeRow {
  std::uint32_t id = 0;
  std::string species;
  Vec3 foot_m{0};
  double leaf_area_m2 = 0;
};

struct StandTables {
  Place place;
  int utc_offset_minutes = 0;
  ParFactors par;
  std::vector<std::string> intervals;
  std::vector<double> begin_s, end_s;  // seconds since 2000-01-01T00:00 UTC
  std::vector<TreeRow> trees;          // rows of the tree table
  std::size_t virtual_trees = 0;       // left out
  std::vector<SensorRow> sensors;
  StandGround map;
  double layer_m = 1;  // layers and levels count from the ground
  // Layers hold all trees, virtual ones too: leaf area density is over the ground all of them stand on.
  double layer_area_m2 = 0;
  std::vector<double> ring_bounds_deg;  // one more than rings; empty without canopy views
  std::vector<double> angles_deg;       // rows of the angle table
  std::vector<StandTable> tables;       // only those with rows and variables
  Provenance provenance;

  const StandTable* find(StandTarget target) const;
  // nullptr: not there.
  const StandVariable* find(StandTarget target, const std::string& name) const;
};

struct StandTableOptions {
  bool virtual_trees = false;  // keep them in the tree table
};
// `forest`: the one of the study.
StandTables stand_tables(const StandStudy& study, const Forest& forest,
                         const StandTableOptions& options = {});

// The plot's table alone.
StandTable plot_figures(const StandStudy& study, const Forest& forest);

// "PAR" -> "par", "Near IR" -> "near_ir": a band's name as part of a variable's.
std::string band_word(const std::string& band);

}  // namespace sunfleck
