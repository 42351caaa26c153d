// Sums of a light map file: per tree, and per band the energy budget and the mean over all elements.
#include "lighting/map/netcdf_sink.h"

namespace sunfleck::netcdf {
namespace {

template <class T, class ValueOf>
void write_tree_column(const Sink& sink, int variable, const std::vector<TreeLight>& trees,
                       const ValueOf& value_of) {
  std::vector<T> values;
  for (const TreeLight& tree : trees) values.push_back(value_of(tree));
  put(sink, variable, {0}, {trees.size()}, values);
}

void write_stem_feet(const Sink& sink, const Forest& forest, const std::vector<TreeLight>& trees) {
  const std::vector<int> at{sink.dimensions.tree};
  const auto write = [&](const char* name, const char* long_name, auto coordinate) {
    write_tree_column<double>(sink, define(sink, name, NC_DOUBLE, at, {"m", long_name, nullptr}), trees,
                              [&](const TreeLight& t) { return coordinate(forest.instances[t.instance]); });
  };
  write("tree_x", "stem foot, towards east", [](const Instance& i) { return i.position_m.x; });
  write("tree_y", "stem foot, towards north", [](const Instance& i) { return i.position_m.y; });
  write("tree_z", "stem foot, upwards", [](const Instance& i) { return i.position_m.z; });
}

void write_tree_names(const Sink& sink, const std::vector<TreeLight>& trees) {
  const std::vector<int> at{sink.dimensions.tree};
  const int number = define(sink, "tree_inventory_id", NC_UINT, at,
                            {"1", "number of the tree in its inventory, as in tree_id", kTreePlace});
  write_tree_column<std::uint32_t>(sink, number, trees, [](const TreeLight& t) { return t.tree.value; });
  const int instance =
      define(sink, "tree_instance", NC_UINT, at, {"1", "index of the tree in the forest", kTreePlace});
  write_tree_column<std::uint32_t>(sink, instance, trees, [](const TreeLight& t) { return t.instance; });
}

double value_of(const TreeField& field, TreeLight tree) { return field.of(tree); }

void write_tree_fields(const Sink& sink, const LightMap& map) {
  const std::size_t count = sink.dimensions.trees;
  for (const TreeField& field : kTreeFields)
    write_tree_column<double>(sink,
                              define(sink, field.name, NC_DOUBLE, {sink.dimensions.tree},
                                     {field.units, field.long_name, kTreePlace}),
                              map.bands.front().trees,
                              [&](const TreeLight& t) { return value_of(field, t); });
  for (const TreeField& field : kBandTreeFields) {
    const int variable = define(sink, field.name, NC_DOUBLE, {sink.dimensions.band, sink.dimensions.tree},
                                {field.units, field.long_name, kTreeBandPlace});
    for (std::size_t b = 0; b < map.bands.size(); ++b) {
      std::vector<double> values;
      for (const TreeLight& tree : map.bands[b].trees) values.push_back(value_of(field, tree));
      put(sink, variable, {b, 0}, {1, count}, values);
    }
  }
}

void write_band_names(const Sink& sink, const LightMap& map) {
  const int variable =
      define(sink, "band_name", NC_STRING, {sink.dimensions.band}, {nullptr, "spectral band", nullptr});
  std::vector<const char*> names;
  for (const BandLightMap& band : map.bands) names.push_back(band.band.c_str());
  put(sink, variable, {0}, {names.size()}, names);
}

template <class FlagOf>
void write_band_flag(const Sink& sink, const LightMap& map, const char* name, const char* long_name,
                     const FlagOf& flag_of) {
  const int variable = define(sink, name, NC_BYTE, {sink.dimensions.band}, {nullptr, long_name, "band_name"});
  const signed char values[] = {0, 1};
  sink.file.check(nc_put_att_schar(sink.file.id(), variable, "flag_values", NC_BYTE, 2, values), name);
  sink.file.put_text(variable, "flag_meanings", "no yes");
  std::vector<signed char> flags;
  for (const BandLightMap& band : map.bands) flags.push_back(flag_of(band) ? 1 : 0);
  put(sink, variable, {0}, {flags.size()}, flags);
}

}  // namespace

void write_trees(const Sink& sink, const Forest& forest, const LightMap& map) {
  write_stem_feet(sink, forest, map.bands.front().trees);
  write_tree_names(sink, map.bands.front().trees);
  write_tree_fields(sink, map);
}

void write_bands(const Sink& sink, const LightMap& map) {
  write_band_names(sink, map);
  write_band_flag(sink, map, "has_standard_error", "the method gave standard errors in this band",
                  [](const BandLightMap& band) { return !band.standard_error_w_m2.empty(); });
  write_band_flag(sink, map, "has_budget", "the method followed the energy budget in this band",
                  [](const BandLightMap& band) { return band.has_budget; });
  for (const BandField& field : kBandFields) {
    const int variable = define(sink, field.name, NC_DOUBLE, {sink.dimensions.band},
                                {field.units, field.long_name, "band_name"});
    std::vector<double> values;
    for (BandLightMap band_copy; const BandLightMap& band : map.bands) {
      band_copy.budget = band.budget;
      band_copy.mean_irradiance_w_m2 = band.mean_irradiance_w_m2;
      band_copy.mean_irradiance_standard_error_w_m2 = band.mean_irradiance_standard_error_w_m2;
      values.push_back(field.of(band_copy));
    }
    put(sink, variable, {0}, {values.size()}, values);
  }
}

}  // namespace sunfleck::netcdf
