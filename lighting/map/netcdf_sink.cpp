#include "lighting/map/netcdf_sink.h"

#include <algorithm>

namespace sunfleck::netcdf {
namespace {

std::size_t chunk_of(const Dimensions& d, int dimension) {
  if (dimension == d.band) return 1;
  return std::clamp<std::size_t>(dimension == d.element ? d.elements : d.trees, 1, kBlock);
}

}  // namespace

Dimensions define_dimensions(const NetcdfHandle& file, const LightMap& map) {
  Dimensions d;
  d.bands = map.bands.size();
  d.elements = map.sunlit_fraction.size();
  d.trees = map.bands.front().trees.size();
  file.check(nc_def_dim(file.id(), "band", d.bands, &d.band), "dimension band");
  file.check(nc_def_dim(file.id(), "element", d.elements, &d.element), "dimension element");
  file.check(nc_def_dim(file.id(), "tree", d.trees, &d.tree), "dimension tree");
  return d;
}

int define(const Sink& sink, const std::string& name, nc_type type, const std::vector<int>& dimensions,
           const Description& description) {
  const NetcdfHandle& file = sink.file;
  const int rank = static_cast<int>(dimensions.size());
  int variable = 0;
  file.check(nc_def_var(file.id(), name.c_str(), type, rank, dimensions.data(), &variable), name);
  if (dimensions.back() != sink.dimensions.band) {
    std::vector<std::size_t> chunks;
    for (const int dimension : dimensions) chunks.push_back(chunk_of(sink.dimensions, dimension));
    file.check(nc_def_var_chunking(file.id(), variable, NC_CHUNKED, chunks.data()), name);
    file.check(nc_def_var_deflate(file.id(), variable, 1, 1, 1), name);
  }
  if (description.units) file.put_text(variable, "units", description.units);
  file.put_text(variable, "long_name", description.long_name);
  if (description.coordinates) file.put_text(variable, "coordinates", description.coordinates);
  return variable;
}

}  // namespace sunfleck::netcdf
