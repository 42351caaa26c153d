// Writes a light map as NetCDF-4 with CF attributes. Equal maps give equal data variables; wall and CPU times
// stand in one global attribute.
#include <algorithm>

#include "lighting/map/light_map_file.h"
#include "lighting/map/netcdf_sink.h"
#include "lighting/map/provenance_json.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

// Bands differ in the light of a tree, not in what the tree is.
bool same_tree(const TreeLight& a, const TreeLight& b) {
  return a.tree == b.tree && a.instance == b.instance && a.leaf_area_m2 == b.leaf_area_m2 &&
         a.sunlit_leaf_area_m2 == b.sunlit_leaf_area_m2;
}

void expect_consistent(const LightMap& map) {
  SUNFLECK_EXPECTS(!map.bands.empty());
  for (const BandLightMap& band : map.bands) {
    SUNFLECK_EXPECTS(band.elements.size() == map.sunlit_fraction.size());
    SUNFLECK_EXPECTS(band.standard_error_w_m2.empty() ||
                     band.standard_error_w_m2.size() == map.sunlit_fraction.size());
    SUNFLECK_EXPECTS(std::equal(band.trees.begin(), band.trees.end(), map.bands.front().trees.begin(),
                                map.bands.front().trees.end(), same_tree));
  }
}

void require_same_size(const LightMap& map, const ForestIndex& index, const std::filesystem::path& path) {
  const std::size_t trees = map.bands.front().trees.size();
  if (map.sunlit_fraction.size() == index.element_count() && (trees == 0 || trees == index.instance_count()))
    return;
  throw_invalid(path.string(),
                "the light map has " + std::to_string(map.sunlit_fraction.size()) + " elements and " +
                    std::to_string(trees) + " trees, the forest " + std::to_string(index.element_count()) +
                    " and " + std::to_string(index.instance_count()),
                "give the forest the map was made for");
}

void write_header(const NetcdfHandle& file, const LightMap& map, const Forest& forest) {
  const Provenance& p = map.provenance;
  const auto text = [&](const char* name, const std::string& value) {
    file.put_text(NC_GLOBAL, name, value);
  };
  text("Conventions", "CF-1.9");  // 1.9 is the first with unsigned integers, which tree ids are
  text("title", "Light on every foliage element of a forest");
  text("source", "sunfleck " + p.version + ", method " + p.method);
  text("history", "made by sunfleck " + p.version + " with method " + p.method);
  text("comment", "x east, y north, z up; irradiances are per area of one face");
  text(netcdf::kFormatName, netcdf::kFormat);
  text("forest_name", forest.name);
  text("method", p.method);
  text("version", p.version);
  text("forest_hash", p.forest_hash);
  const auto seed = static_cast<unsigned long long>(p.seed);
  file.check(nc_put_att_ulonglong(file.id(), NC_GLOBAL, "seed", NC_UINT64, 1, &seed), "attribute seed");
  text("settings", settings_to_json(p));
  text("skipped", skipped_to_json(p));
  text("notes", notes_to_json(p));
  text("times", times_to_json(p));
}

}  // namespace

void save_netcdf(const LightMap& map, const Forest& forest, const std::filesystem::path& path) {
  expect_consistent(map);
  const ForestIndex index(forest);
  require_same_size(map, index, path);
  PendingFile pending(path);
  {
    NetcdfHandle file = NetcdfHandle::create(pending.path(), path);
    write_header(file, map, forest);
    const netcdf::Sink sink{file, netcdf::define_dimensions(file, map)};
    netcdf::write_bands(sink, map);
    netcdf::write_trees(sink, forest, map);
    netcdf::write_geometry(sink, forest, index);
    netcdf::write_light(sink, map);
    file.close();
  }
  pending.commit();
}

}  // namespace sunfleck
