// A tiny stand and a stand light request for it that is answered within tens of milliseconds.
#pragma once

#include "lighting/study/stand_study.h"
#include "tests/server/served.h"

namespace sunfleck::test {

// Four crowns of a few leaves on a plot that repeats every 12 m.
inline ForestSpec tiny_stand() {
  ForestSpec spec = row_of_trees(4, 40);
  spec.period = Period{{-2, -6}, {16, 12}};
  return spec;
}

inline RadiationTable months() {
  return parse_radiation(
      "month,global_horizontal_mj_m2,diffuse_fraction\n6,560,0.5\n7,580.3,0.47\n8,500.1,0.51\n", "table.csv");
}

// An hour of sun a row.
inline RadiationTable hours() {
  return parse_radiation(
      "time,global_horizontal_w_m2\n2024-06-21T10:00+02:00,480\n2024-06-21T11:00+02:00,610.25\n"
      "2024-06-21T12:00+02:00,700\n",
      "hours.csv");
}

inline StandStudySpec tiny_study() {
  StandStudySpec spec;
  spec.place = {50, 5, 200};
  spec.period = parse_period("2020-06-01T00:00+01:00", "2020-08-01T00:00+01:00", "test");
  spec.radiation = "table.csv";
  spec.radiation_table = months();
  spec.optics = {{"PAR", "NIR"}, {0.1, 0.25}, {}};
  spec.ground_cell_m = 4;
  spec.layer_m = 3;
  spec.rays_per_cell = 30;
  spec.tree_relative_error = 0;
  spec.patch_deg = 30;
  spec.bin_deg = 30;
  spec.sensors = {{{"a", {2, 1}, 1, {0, 0, 1}}, 0.4, {}, {}},
                  {{"", {7, 2}, 1.5, {0, 0.6, 0.8}}, 0.3, 0.2, 0.4}};
  return spec;
}

// Of minutes; can be stopped.
inline StandStudySpec slow_study() {
  StandStudySpec spec = tiny_study();
  spec.rays_per_cell = 1e7;
  return spec;
}

}  // namespace sunfleck::test
