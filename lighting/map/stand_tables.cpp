#include "lighting/map/stand_tables.h"

#include <algorithm>
#include <cctype>

#include "lighting/map/stand_variables.h"
#include "sim/base/contract.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

namespace stand {

namespace {

void append(const IntervalTable& from, const std::vector<std::size_t>& rows, double factor, Errors errors,
            StandVariable& variable) {
  const std::size_t count = rows.empty() ? from.targets : rows.size();
  for (std::size_t i = 0; i < from.intervals; ++i)
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t t = rows.empty() ? k : rows[k];
      variable.value.push_back(factor * from.at(i, t));
      if (errors == Errors::kKeep) variable.standard_error.push_back(factor * from.error_at(i, t));
    }
}

}  // namespace

void fill(const Source& source, const std::vector<std::size_t>& rows, double factor, Errors errors,
          StandVariable& variable) {
  for (const IntervalTable* table : {source.period, source.parts})
    if (table) append(*table, rows, factor, errors, variable);
}

IntervalTable whole_of(const IntervalTable& parts, const std::vector<double>& weight) {
  SUNFLECK_EXPECTS(weight.size() == parts.intervals);
  IntervalTable whole(1, parts.targets);
  double all = 0;
  for (const double w : weight) all += w;
  for (std::size_t t = 0; all > 0 && t < parts.targets; ++t) {
    double sum = 0;
    for (std::size_t i = 0; i < parts.intervals; ++i) sum += weight[i] * parts.at(i, t);
    whole.value[t] = static_cast<float>(sum / all);
  }
  return whole;
}

IntervalTable whole_of(const IntervalTable& parts) {
  IntervalTable whole = whole_of(parts, std::vector<double>(parts.intervals, 1.0));
  for (float& v : whole.value) v *= static_cast<float>(parts.intervals);
  return whole;
}

}  // namespace stand

namespace {

std::string species_of(const Forest& forest, const Instance& tree) {
  const std::vector<std::string>& materials = forest.prototypes[tree.prototype.value].materials;
  return materials.empty() ? std::string() : materials.front();
}

std::vector<std::size_t> rows_of(const Forest& forest, bool virtual_trees) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < forest.instances.size(); ++i)
    if (virtual_trees || !is_virtual(forest.instances[i].tree)) rows.push_back(i);
  return rows;
}

// Leaf area per prototype once, then per instance: forests share prototypes.
std::vector<TreeRow> describe_trees(const Forest& forest, const std::vector<std::size_t>& rows) {
  std::vector<double> area_m2(forest.prototypes.size(), -1);
  std::vector<TreeRow> trees;
  for (const std::size_t i : rows) {
    const Instance& tree = forest.instances[i];
    double& own = area_m2[tree.prototype.value];
    if (own < 0) own = leaf_area_m2(forest.prototypes[tree.prototype.value]);
    trees.push_back({tree.tree.value, species_of(forest, tree), tree.position_m,
                     own * static_cast<double>(tree.scale) * tree.scale});
  }
  return trees;
}

// Periodic: the map. Else what the trees cover, or the map where that is larger.
double layer_area_m2(const Forest& forest, const StandGround& map) {
  const double map_m2 = map.size_m().x * map.size_m().y;
  const Vec3 size = forest_bounds(forest).size();
  return map.periodic ? map_m2 : std::max(map_m2, size.x * size.y);
}

void keep(StandTable table, StandTables& all) {
  if (table.rows > 0 && !table.variables.empty()) all.tables.push_back(std::move(table));
}

}  // namespace

std::string to_string(StandTarget target) {
  constexpr const char* kNames[] = {"plot", "tree", "sensor", "ground", "layer", "level", "angle"};
  return kNames[static_cast<int>(target)];
}

std::string band_word(const std::string& band) {
  std::string word;
  for (const char c : band) {
    const auto u = static_cast<unsigned char>(c);
    word += std::isalnum(u) && u < 128 ? static_cast<char>(std::tolower(u)) : '_';
  }
  return word;
}

const StandVariable* StandTable::find(const std::string& name) const {
  for (const StandVariable& v : variables)
    if (v.name == name) return &v;
  return nullptr;
}

const StandTable* StandTables::find(StandTarget target) const {
  for (const StandTable& t : tables)
    if (t.target == target) return &t;
  return nullptr;
}

const StandVariable* StandTables::find(StandTarget target, const std::string& name) const {
  const StandTable* table = find(target);
  return table ? table->find(name) : nullptr;
}

StandTable plot_figures(const StandStudy& study, const Forest& forest) {
  StandTable plot = stand::plot_table(study);
  const std::vector<std::size_t> own = rows_of(forest, false);
  if (study.period && own.size() < forest.instances.size() && study.spec.plot_area_m2 > 0)
    stand::count_own_trees(study, own, plot);
  return plot;
}

StandTables stand_tables(const StandStudy& study, const Forest& forest, const StandTableOptions& options) {
  SUNFLECK_EXPECTS(study.period || study.world);
  const std::vector<std::size_t> rows = rows_of(forest, options.virtual_trees);
  StandTables all;
  all.place = study.spec.place;
  all.utc_offset_minutes = study.spec.period.offset_minutes;
  all.par = study.spec.par;
  all.intervals = study.intervals;
  all.begin_s = study.interval_begin_s;
  all.end_s = study.interval_end_s;
  all.trees = describe_trees(forest, rows);
  all.virtual_trees = forest.instances.size() - rows_of(forest, false).size();
  if (study.period) all.sensors = study.spec.sensors;
  all.map = study.period ? study.period->map : study.world->map;
  all.provenance = study.provenance;
  if (study.period) {
    all.layer_m = study.period->layers.layer_m;
    all.layer_area_m2 = layer_area_m2(forest, all.map);
    all.angles_deg = study.period->plot.zenith_deg;
    if (!study.period->canopy.empty()) {
      all.ring_bounds_deg.push_back(0);
      for (const GapRing& ring : study.period->canopy.front().rings_10_deg)
        all.ring_bounds_deg.push_back(ring.to_deg);
    }
  }
  keep(plot_figures(study, forest), all);
  keep(stand::angle_table(study), all);
  keep(stand::tree_table(study, rows), all);
  keep(stand::sensor_table(study), all);
  keep(stand::ground_table(study), all);
  keep(stand::layer_table(study, all.layer_area_m2), all);
  keep(stand::level_table(study), all);
  return all;
}

}  // namespace sunfleck
