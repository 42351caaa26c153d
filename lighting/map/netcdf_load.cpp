// Reads a light map back from NetCDF-4, bit by bit as it was saved. The forest's part (places, areas) is left
// to the forest.
#include <algorithm>
#include <cstring>

#include "lighting/map/light_map_file.h"
#include "lighting/map/netcdf_handle.h"
#include "lighting/map/netcdf_schema.h"
#include "lighting/map/provenance_json.h"
#include "sim/base/error.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

using namespace netcdf;

void require_our_format(const NetcdfHandle& file) {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  const bool marked =
      nc_inq_att(file.id(), NC_GLOBAL, kFormatName, &type, &length) == NC_NOERR && type == NC_CHAR;
  if (!marked)
    throw_invalid(file.shown(), "is a NetCDF file but not a light map",
                  "name a file that `sunfleck light` or save_netcdf wrote");
  const std::string format = file.text_attribute(kFormatName);
  if (format != kFormat)
    throw_invalid(file.shown(), "holds '" + format + "', this program reads '" + kFormat + "'",
                  std::string("read it with the version of sunfleck that wrote it, this is ") + kVersion);
}

template <class T>
std::vector<T> read(const NetcdfHandle& file, const std::string& name, const std::vector<std::size_t>& shape,
                    std::vector<std::size_t> start, const std::vector<std::size_t>& count) {
  const int variable = file.variable(name, shape);
  std::size_t size = 1;
  for (const std::size_t n : count) size *= n;
  std::vector<T> values(size);
  if (size == 0) return values;
  int status = NC_NOERR;
  if constexpr (std::is_same_v<T, float>)
    status = nc_get_vara_float(file.id(), variable, start.data(), count.data(), values.data());
  else if constexpr (std::is_same_v<T, double>)
    status = nc_get_vara_double(file.id(), variable, start.data(), count.data(), values.data());
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    status = nc_get_vara_uint(file.id(), variable, start.data(), count.data(), values.data());
  else
    status = nc_get_vara_schar(file.id(), variable, start.data(), count.data(), values.data());
  file.check(status, "variable " + name);
  return values;
}

Provenance read_provenance(const NetcdfHandle& file) {
  Provenance p;
  p.method = file.text_attribute("method");
  p.version = file.text_attribute("version");
  p.forest_hash = file.text_attribute("forest_hash");
  p.seed = file.seed_attribute();
  read_json({file.text_attribute("settings"), file.text_attribute("skipped"), file.text_attribute("notes"),
             file.text_attribute("times")},
            file.shown(), p);
  return p;
}

void read_bands(const NetcdfHandle& file, LightMap& map) {
  const std::size_t bands = map.bands.size();
  const std::vector<std::string> names = file.texts("band_name", bands);
  const auto has_budget = read<signed char>(file, "has_budget", {bands}, {0}, {bands});
  for (std::size_t b = 0; b < bands; ++b) {
    map.bands[b].band = names[b];
    map.bands[b].has_budget = has_budget[b] != 0;
  }
  for (const BandField& field : kBandFields) {
    const auto values = read<double>(file, field.name, {bands}, {0}, {bands});
    for (std::size_t b = 0; b < bands; ++b) field.of(map.bands[b]) = values[b];
  }
}

// What a tree is, the same for every band.
std::vector<TreeLight> read_tree_list(const NetcdfHandle& file, std::size_t trees) {
  std::vector<TreeLight> list(trees);
  const auto number = read<std::uint32_t>(file, "tree_inventory_id", {trees}, {0}, {trees});
  const auto instance = read<std::uint32_t>(file, "tree_instance", {trees}, {0}, {trees});
  for (std::size_t t = 0; t < trees; ++t) {
    list[t].tree.value = number[t];
    list[t].instance = instance[t];
  }
  for (const TreeField& field : kTreeFields) {
    const auto values = read<double>(file, field.name, {trees}, {0}, {trees});
    for (std::size_t t = 0; t < trees; ++t) field.of(list[t]) = values[t];
  }
  return list;
}

void read_trees(const NetcdfHandle& file, LightMap& map) {
  const std::size_t bands = map.bands.size(), trees = file.dimension("tree");
  const std::vector<TreeLight> list = read_tree_list(file, trees);
  for (std::size_t b = 0; b < bands; ++b) {
    map.bands[b].trees = list;
    for (const TreeField& field : kBandTreeFields) {
      const auto values = read<double>(file, field.name, {bands, trees}, {b, 0}, {1, trees});
      for (std::size_t t = 0; t < trees; ++t) field.of(map.bands[b].trees[t]) = values[t];
    }
  }
}

void read_light(const NetcdfHandle& file, LightMap& map) {
  const std::size_t bands = map.bands.size(), elements = file.dimension("element");
  map.sunlit_fraction = read<float>(file, "sunlit_fraction", {elements}, {0}, {elements});
  const auto has_error = read<signed char>(file, "has_standard_error", {bands}, {0}, {bands});
  for (std::size_t b = 0; b < bands; ++b) {
    BandLightMap& band = map.bands[b];
    band.elements.resize(elements);
    for (const ElementField& field : kElementFields) {
      const auto values = read<float>(file, field.name, {bands, elements}, {b, 0}, {1, elements});
      for (std::size_t i = 0; i < elements; ++i) field.of(band.elements[i]) = values[i];
    }
    if (has_error[b] != 0)
      band.standard_error_w_m2 =
          read<float>(file, "irradiance_standard_error", {bands, elements}, {b, 0}, {1, elements});
  }
}

LightMap read_map(const NetcdfHandle& file) {
  LightMap map;
  map.provenance = read_provenance(file);
  map.bands.resize(file.dimension("band"));
  if (map.bands.empty()) throw_invalid(file.shown(), "has no band", "save the light map again");
  read_bands(file, map);
  read_trees(file, map);
  read_light(file, map);
  return map;
}

}  // namespace

LightMap load_netcdf(const std::filesystem::path& path) {
  NetcdfHandle file = NetcdfHandle::open(path);
  require_our_format(file);
  try {
    return read_map(file);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::kLimitExceeded, path.string(), "holds more elements than fit in memory",
                "use a machine with more memory");
  } catch (const std::length_error&) {
    throw_invalid(path.string(), "states an impossible number of elements", "save the light map again");
  }
}

}  // namespace sunfleck
