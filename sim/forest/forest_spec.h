// What a forest shall be, as plain options, and the function that grows it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/config/config_table.h"
#include "sim/forest/forest.h"
#include "sim/forest/plot_polygon.h"
#include "sim/growth/grow_together.h"
#include "sim/plant/species.h"

namespace sunfleck {

// One row of an inventory; columns as in the measured stands: id_tree, species, x, y, dbh_cm and, if known,
// crown_type, h_m, hbase_m, hmax_m, rn_m, rs_m, re_m, rw_m, crown_lad. Missing ones come from the allometry
// of trees of its form.
struct InventoryTree {
  TreeId id;
  std::string species;
  double x_m = 0, y_m = 0, dbh_cm = 0;
  std::optional<double> height_m, crown_base_m, widest_m, radius_n_m, radius_s_m, radius_e_m, radius_w_m,
      leaf_area_density_per_m;
  TreeForm form = TreeForm::kStandGrown;
  std::string where;  // "file:line" of its row or the planting rule, for messages; empty if from neither
  // A tree of the surroundings that looks like this one of the inventory, turned.
  std::optional<TreeId> copy_of;
  double copy_yaw_rad = 0;
};

// Trees of an inventory are numbered up to here; larger numbers are for trees that nobody measured.
inline constexpr std::uint32_t kLargestTreeNumber = 0x7fffffff;
inline TreeId virtual_tree(std::size_t number) {
  return {kLargestTreeNumber + 1 + static_cast<std::uint32_t>(number)};
}
inline bool is_virtual(TreeId tree) { return tree.value > kLargestTreeNumber; }

// Throws Error(kInvalidInput) with "file:line, column": missing column, not a number, negative, duplicate id,
// crown base above the top. An empty table is an error.
// `form`: of rows that state none.
std::vector<InventoryTree> read_inventory(const std::filesystem::path& path,
                                          TreeForm form = TreeForm::kStandGrown);
std::vector<InventoryTree> parse_inventory(std::string_view csv, const std::string& name,
                                           TreeForm form = TreeForm::kStandGrown);

enum class PlantingPattern { kPoissonDisc, kRows, kRandom };
struct PlantingRule {
  std::string species;
  int count = 100;  // trees asked for; Poisson disc plants fewer when they do not fit (and says so)
  PlantingPattern pattern = PlantingPattern::kPoissonDisc;
  double spacing_m = 3;  // least distance (Poisson disc) or grid step (rows)
  double dbh_mean_cm = 25, dbh_sd_cm = 5;
  TreeForm form = TreeForm::kStandGrown;
};

// How trees become geometry.
enum class TreeSource {
  kLsystem,  // the species' grammar. Trees of which only the DBH is known share prototypes per species, size
             // class and variant, scaled to the tree; a tree with any other measure gets one of its own size
             // (crown radius: the mean of the stated ones; hmax_m only keeps the tree taller than that)
  kCrown     // one prototype per tree: its own crown shape filled with leaves
};

// kCrown: what fills a crown.
enum class CrownFilling {
  kLeaves,  // leaves of the species' angles, placed by the keys below
  kGrown    // a tree of the species' grammar moved into the shape, see crown_filling.h; leaves where there is
            // none
};

// What stands beyond the border of an inventoried plot, see surroundings.h.
enum class Surroundings { kNone, kPeriodic, kMirrored, kSimilar };

// kCrown: leaves in clumps instead of evenly. Clump centres are even in the crown, leaves even in their
// clump.
struct LeafClumps {
  double radius_m = 0;      // 0: none
  int elements = 20;        // of a clump
  double leaf_area_m2 = 0;  // of a clump; above 0: instead of `elements`
};

// Where a tree's leaf area comes from.
enum class LeafAreaSource {
  kDensity,   // crown_lad times the crown's volume where the row states it, else foliage mass by DBH
  kAllometry  // the law of harvested trees of the species (DBH and height), whatever the row says
};

// Trees too small to have been measured, see understorey.h.
struct Understorey {
  bool add = false;
  double smallest_dbh_cm = 1;
  double inventoried_from_dbh_cm = 0;  // 0: found from the diameters
  double stems_ratio_per_5_cm = 1.4;   // de Liocourt's quotient
  double stems_factor = 1;             // multiplies the number of trees added
  double light_power = 1;              // 0: anywhere; 1: where the crowns above let light through
};

// kLsystem: trees grow up from seed at their places, all together, by the light their buds get (sim/growth),
// instead of to a size. Who answers: the fast approximation of growth itself, or the method `grid` of
// lighting.
enum class GrowthLight { kOpenness, kGrid };
std::string to_string(GrowthLight light);  // "openness", "grid"
struct GrowInLight {
  int years = 25;            // 1 to 200
  double stop_height_m = 0;  // above 0: stops in the year in which the tallest tree reaches it
  GrowthLight light = GrowthLight::kOpenness;
  double cell_m = 0.4;  // of the leaf-area grid, 0.1 to 5
};
// Makes who answers for a site. Forests grow in sim, which knows no light of lighting's.
using GrowthLightMaker = std::function<BudLight(const GrowthSite& site, const RunControl& control)>;

struct ForestSpec {
  std::string name = "forest";
  std::uint64_t seed = 1;
  TreeSource trees = TreeSource::kLsystem;
  std::vector<InventoryTree> inventory;  // either this
  std::vector<PlantingRule> planting;    // or this, inside [0, width] x [0, depth]
  double plot_width_m = 0, plot_depth_m = 0;
  std::optional<PlotPolygon> plot;  // the inventoried area; without: the rectangle around the trees
  Surroundings surroundings = Surroundings::kNone;
  double surroundings_width_m = 0;               // 0: twice the height of the tall trees
  CrownFilling filling = CrownFilling::kLeaves;  // kCrown
  int elements_per_tree = 1000;                  // kCrown: foliage elements per tree
  LeafClumps clumps;                             // kCrown
  double leaf_area_factor = 1;                   // multiplies the leaf area of every tree
  LeafAreaSource leaf_area = LeafAreaSource::kDensity;
  double element_area_m2 = 0;  // kCrown: above 0: leaf area of an element, instead of elements_per_tree
  double rim_power = 0;        // kCrown: see CrownFill
  double height_power = 0;     // kCrown: see CrownFill
  double branch_share = 0;     // kCrown: see CrownFill
  Understorey understorey;     // only with an inventory
  double detail = 1.0;         // kLsystem: share of the foliage elements kept, (0, 1]
  int size_classes = 4;        // kLsystem: DBH classes per species
  int variants = 2;            // kLsystem: prototypes per class
  std::optional<GrowInLight> grow_in_light;  // kLsystem
  Terrain terrain;
  std::optional<Period> period;
};

// The rectangle around the trees and half the mean distance between them: the plot where no polygon is given.
PlotPolygon plot_around(const std::vector<InventoryTree>& trees);

// Reads the [forest] table of a scene file (see configs/scenes); inventory paths are relative to the file.
ForestSpec read_forest_spec(const ConfigTable& table);

// Grows it. Deterministic in (spec, species). Throws Error for unknown species, no trees, or limits. `notes`
// receives one sentence for each thing that did not come out as asked: trees that found no place, heights
// that were not met. `grid_light`: answers a spec that grows in GrowthLight::kGrid
// (lighting/plan/growth_light.h); without it such a spec is refused.
Forest grow_forest(const ForestSpec& spec, const SpeciesLibrary& species, const RunControl& control,
                   std::vector<std::string>* notes = nullptr, const GrowthLightMaker& grid_light = {});

}  // namespace sunfleck
