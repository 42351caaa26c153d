// Where the parts of a light map are written to: the open file with its three dimensions.
#pragma once

#include <string>
#include <vector>

#include "lighting/map/netcdf_handle.h"
#include "lighting/map/netcdf_schema.h"
#include "sim/forest/forest.h"

namespace sunfleck::netcdf {

struct Dimensions {
  int band = 0, element = 0, tree = 0;
  std::size_t bands = 0, elements = 0, trees = 0;
};

struct Sink {
  NetcdfHandle& file;
  Dimensions dimensions;
};

struct Description {
  const char* units;
  const char* long_name;
  const char* coordinates;  // nullptr: none
};

inline constexpr char kElementPlace[] = "x y z";
inline constexpr char kElementBandPlace[] = "x y z band_name";
inline constexpr char kTreePlace[] = "tree_x tree_y tree_z";
inline constexpr char kTreeBandPlace[] = "tree_x tree_y tree_z band_name";

Dimensions define_dimensions(const NetcdfHandle& file, const LightMap& map);
// Chunked, shuffled and deflated where it has elements or trees; plain for the few values per band.
int define(const Sink& sink, const std::string& name, nc_type type, const std::vector<int>& dimensions,
           const Description& description);

// `values` in the type the variable was defined with.
template <class T>
void put(const Sink& sink, int variable, const std::vector<std::size_t>& start,
         const std::vector<std::size_t>& count, const std::vector<T>& values) {
  if (values.empty()) return;
  sink.file.check(nc_put_vara(sink.file.id(), variable, start.data(), count.data(), values.data()),
                  "writing values");
}

// The parts: where and what the elements are; their light; sums per tree and per band.
void write_geometry(const Sink& sink, const Forest& forest, const ForestIndex& index);
void write_light(const Sink& sink, const LightMap& map);
void write_trees(const Sink& sink, const Forest& forest, const LightMap& map);
void write_bands(const Sink& sink, const LightMap& map);

}  // namespace sunfleck::netcdf
