// Tables and density grids in and out of a .vdb file. The one place that knows OpenVDB.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "sim/grid/forest_file.h"
#include "sim/grid/point_table.h"

namespace sunfleck {

struct VdbContent {
  std::string description;  // text stored in the file's metadata
  std::vector<DensityGrid> densities;
  std::vector<PointTable> tables;
};

// Writes a whole .vdb to a seekable stream that throws on failure. Tables without rows are left out.
void write_vdb(const VdbContent& content, std::ostream& out);

// Reads description and tables (rows in the order in which they were written); density grids are derived
// data and stay unread. Throws std::exception of many kinds on a file that is not what write_vdb wrote.
VdbContent read_vdb(const std::filesystem::path& path);

// The same of the tables whose names are wanted; nothing of the others is read.
VdbContent read_vdb(const std::filesystem::path& path, const std::function<bool(const std::string&)>& wanted);

// Grid metadata only.
std::vector<GridSummary> summarize_vdb(const std::filesystem::path& path);

}  // namespace sunfleck
