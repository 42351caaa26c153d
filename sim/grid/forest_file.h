// The forest as ONE .vdb file that OpenVDB's own tools open: a leaf-area-density grid per prototype, point
// grids of foliage elements and of instances, metadata for the rest. Reopens to a bit-identical Forest.
#pragma once

#include <filesystem>
#include <string>

#include "sim/forest/forest.h"

namespace sunfleck {

// Writes to a temporary name beside `path` and renames: a failure leaves no file that looks whole.
// Throws Error(kInputOutput) naming the path.
void save_forest(const Forest& forest, const std::filesystem::path& path);

// Throws Error: kNotFound without a file; kInvalidInput for something that is no .vdb file, is truncated, was
// written by another program (metadata missing) or whose stored content hash does not match what was read.
Forest load_forest(const std::filesystem::path& path);

// What `sunfleck info` prints of a file: grids with type, voxel size and active voxels; read without the
// elements.
struct GridSummary {
  std::string name, type;
  double voxel_size_m = 0;
  std::uint64_t active_voxels = 0;
  double integral = 0;  // leaf area in m2 for leaf-area-density grids, number of points for point grids
};
std::vector<GridSummary> summarize_forest_file(const std::filesystem::path& path);

}  // namespace sunfleck
