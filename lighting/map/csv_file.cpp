// Light maps as CSV: one line per element (or tree) and band.
#include "lighting/map/csv_writer.h"
#include "lighting/map/light_map_file.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::vector<std::string> band_texts(const LightMap& map) {
  std::vector<std::string> names;
  for (const BandLightMap& band : map.bands) names.push_back(csv_quoted(band.band));
  return names;
}

void write_place(CsvWriter& csv, const Forest& forest, std::size_t i, const ForestIndex::Place& place) {
  const WorldElement element = world_element(forest, place.instance, place.local);
  csv.number(i);
  csv.number(forest.instances[place.instance].tree.value);
  csv.number(element.centre_m.x);
  csv.number(element.centre_m.y);
  csv.number(element.centre_m.z);
  csv.number(element.area_m2);
}

void write_face(CsvWriter& csv, const FaceLight& face) {
  csv.number(face.direct_w_m2);
  csv.number(face.sky_w_m2);
  csv.number(face.scattered_w_m2);
}

void write_light(CsvWriter& csv, const BandLightMap& band, std::size_t i, float sunlit_fraction) {
  write_face(csv, band.elements[i].front);
  write_face(csv, band.elements[i].back);
  csv.number(band.elements[i].absorbed_w);
  csv.number(sunlit_fraction);
  if (band.standard_error_w_m2.empty())
    csv.text("");
  else
    csv.number(band.standard_error_w_m2[i]);
  csv.end_line();
}

void require(bool matches, const std::filesystem::path& path, const char* what) {
  if (!matches)
    throw_invalid(path.string(), std::string("light map and forest differ in their number of ") + what,
                  "give the forest the map was made for");
}

void write_tree(CsvWriter& csv, const Forest& forest, const TreeLight& tree, const std::string& band) {
  const Vec3& foot_m = forest.instances[tree.instance].position_m;
  csv.number(tree.tree.value);
  csv.number(tree.instance);
  csv.number(foot_m.x);
  csv.number(foot_m.y);
  csv.number(foot_m.z);
  csv.text(band);
  csv.number(tree.leaf_area_m2);
  csv.number(tree.sunlit_leaf_area_m2);
  csv.number(tree.absorbed_w);
  csv.number(tree.absorbed_standard_error_w);
  csv.number(tree.mean_irradiance_w_m2);
  csv.end_line();
}

}  // namespace

void save_element_csv(const LightMap& map, const Forest& forest, const std::filesystem::path& path) {
  const ForestIndex index(forest);
  require(map.sunlit_fraction.size() == index.element_count(), path, "elements");
  for (const BandLightMap& band : map.bands)
    SUNFLECK_EXPECTS(
        band.elements.size() == index.element_count() &&
        (band.standard_error_w_m2.empty() || band.standard_error_w_m2.size() == index.element_count()));
  write_csv(path, [&](CsvWriter& csv) {
    csv.text(
        "element,tree_id,x_m,y_m,z_m,area_m2,band,front_direct_w_m2,front_sky_w_m2,front_scattered_w_m2,"
        "back_direct_w_m2,back_sky_w_m2,back_scattered_w_m2,absorbed_w,sunlit_fraction,standard_error_w_m2");
    csv.end_line();
    const std::vector<std::string> names = band_texts(map);
    for (std::size_t i = 0; i < index.element_count(); ++i)
      for (std::size_t b = 0; b < map.bands.size(); ++b) {
        write_place(csv, forest, i, index.place(i));
        csv.text(names[b]);
        write_light(csv, map.bands[b], i, map.sunlit_fraction[i]);
      }
  });
}

void save_tree_csv(const LightMap& map, const Forest& forest, const std::filesystem::path& path) {
  for (const BandLightMap& band : map.bands)
    require(band.trees.size() == forest.instances.size(), path, "trees");
  write_csv(path, [&](CsvWriter& csv) {
    csv.text(
        "tree_id,instance,x_m,y_m,z_m,band,leaf_area_m2,sunlit_leaf_area_m2,absorbed_w,"
        "absorbed_standard_error_w,mean_irradiance_w_m2");
    csv.end_line();
    const std::vector<std::string> names = band_texts(map);
    for (std::size_t t = 0; t < forest.instances.size(); ++t)
      for (std::size_t b = 0; b < map.bands.size(); ++b)
        write_tree(csv, forest, map.bands[b].trees[t], names[b]);
  });
}

}  // namespace sunfleck
