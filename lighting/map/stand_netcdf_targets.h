// The dimensions of a stand study's NetCDF file and what lies along them: trees, sensors, cells, layers,
// rings. Part of stand_netcdf.h.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lighting/map/netcdf_handle.h"
#include "lighting/map/stand_tables.h"

namespace sunfleck {

class StandTargets {
 public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;  // empty values are left out

  // Both must outlive this.
  StandTargets(const NetcdfHandle& file, const StandTables& all) : file_(file), all_(all) {}

  // Each is made when it is first asked for.
  int dimension(const std::string& name, std::size_t size);
  std::vector<int> target_dimensions(const StandTable& table);
  int ring_dimension(int rings);
  int bounds() { return dimension("bnds", 2); }

  int define(const std::string& name, nc_type type, const std::vector<int>& dimensions,
             const Attributes& attributes);
  void coordinate(const std::string& name, const std::vector<int>& dimensions, const Attributes& attributes,
                  const std::vector<double>& values);
  void texts(const std::string& name, int dimension, const Attributes& attributes,
             const std::vector<std::string>& values);

 private:
  int steps(const std::string& name, std::size_t count, double from, double step, Attributes attributes);
  std::vector<int> ground_dimensions();
  int tree_dimension();
  int sensor_dimension();

  const NetcdfHandle& file_;
  const StandTables& all_;
  std::map<std::string, int> dimensions_;
};

}  // namespace sunfleck
