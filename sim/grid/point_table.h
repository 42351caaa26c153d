// Rows of numbers at places: the plain form of a point grid, so that only vdb_archive.cpp knows OpenVDB. And
// the plain form of a sparse density grid.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

using ColumnValues = std::variant<std::vector<std::int32_t>, std::vector<float>, std::vector<double>,
                                  std::vector<Vec3f>, std::vector<Vec3>>;

struct PointColumn {
  std::string name;
  ColumnValues values;  // one per row
};

// Row i stands at positions_m[i]. The columns hold the exact numbers; positions only place the rows in the
// file's grid (OpenVDB keeps them relative to a voxel, which costs bits) and are empty after reading.
struct PointTable {
  std::string name;   // of the grid, unique in its file
  std::string about;  // what a person reads in the grid's metadata
  std::vector<Vec3> positions_m;
  std::vector<PointColumn> columns;
};

struct DensityCell {
  std::array<std::int32_t, 3> index{};  // the cell's low corner is at index * cell_m
  float value = 0;
};

struct DensityGrid {
  std::string name, about;
  double cell_m = 1;
  std::vector<DensityCell> cells;
  double integral = 0;  // of the density over all cells
};

}  // namespace sunfleck
