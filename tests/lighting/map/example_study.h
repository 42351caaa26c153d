// A small stand with everything a study can hold: two species, trees around the plot that nobody measured,
// sensors with and without measurements (one with a name that tries to break files), months, two bands.
#pragma once

#include <fstream>

#include "lighting/map/stand_tables.h"
#include "sim/forest/forest_spec.h"
#include "tests/support/golden.h"

namespace sunfleck::test {

inline constexpr char kAwkwardName[] = "<b>\"ash, & oak\"</b>";

inline Forest example_stand(Surroundings surroundings = Surroundings::kSimilar) {
  ForestSpec spec;
  spec.name = "stand of <script>alert('x')</script>";
  for (int i = 0; i < 9; ++i) {
    InventoryTree tree;
    tree.id = {static_cast<std::uint32_t>(100 + i)};
    tree.species = i % 3 == 0 ? "Picea abies" : "Fagus sylvatica";
    tree.x_m = 3 + 6 * (i % 3), tree.y_m = 3 + 6 * (i / 3);
    tree.dbh_cm = 20 + i;
    spec.inventory.push_back(tree);
  }
  spec.trees = TreeSource::kCrown;
  spec.elements_per_tree = 60;
  spec.plot = rectangle({0, 0}, {18, 18});
  spec.surroundings = surroundings;
  spec.surroundings_width_m = 6;
  return grow_forest(spec, SpeciesLibrary::load(source_dir() / "configs/species"), {});
}

inline StandStudySpec example_study_spec() {
  const auto table = scratch_dir() / "radiation.csv";
  std::ofstream(table) << "month,global_horizontal_mj_m2,diffuse_fraction\n5,520,0.5\n6,560,0.5\n12,50,0.7\n";
  StandStudySpec spec;
  spec.place = {50.25, -5.5, 400};
  spec.period = parse_period("2020-05-01T00:00+01:00", "2020-07-01T00:00+01:00", "stand_light");
  spec.radiation = table;
  spec.optics = {{"PAR", "NIR"}, {0.1, 0.2}, {}};
  spec.ground_cell_m = 4.5;
  spec.layer_m = 2;
  spec.map_lo_m = Vec2(0, 0), spec.map_hi_m = Vec2(18, 18);
  spec.plot_area_m2 = 324;
  spec.rays_per_cell = 300;
  spec.sensor_sun_rays = 2, spec.sensor_sky_rays = 4;
  spec.patch_deg = 15, spec.bin_deg = 10;
  spec.sensors = {{{kAwkwardName, {7.5, 9}, 1, {0, 0, 1}}, 0.25, 0.3, {}},
                  {{"", {5.5, 12.5}, 2, {0, 0, 1}}, {}, {}, {}},
                  {{"third", {13, 6}, 1, {0, 0, 1}}, 0.125, {}, {}}};
  return spec;
}

// Made once per test program.
struct ExampleStudy {
  Forest forest = example_stand();
  StandStudy study = run_stand_study(forest, example_study_spec(), {});
  StandTables tables = stand_tables(study, forest);
};
inline const ExampleStudy& example_study() {
  static const ExampleStudy made;
  return made;
}

}  // namespace sunfleck::test
