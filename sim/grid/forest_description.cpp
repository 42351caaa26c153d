// Doubles are printed with the shortest digits that read back to the same bits.

#include "sim/grid/forest_description.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/base/error.h"

namespace sunfleck {

namespace {

using nlohmann::json;

constexpr int kFormat = 1;

json json_of(const Material& material) {
  json bands = json::array();
  for (const MaterialBand& band : material.bands) {
    bands.push_back({{"band", band.band},
                     {"leaf_reflectance", band.leaf_reflectance},
                     {"leaf_transmittance", band.leaf_transmittance},
                     {"bark_reflectance", band.bark_reflectance}});
  }
  return {{"name", material.name}, {"bands", bands}};
}

Material material_from(const json& text) {
  Material material{text.at("name").get<std::string>(), {}};
  for (const json& band : text.at("bands")) {
    material.bands.push_back({band.at("band").get<std::string>(), band.at("leaf_reflectance").get<double>(),
                              band.at("leaf_transmittance").get<double>(),
                              band.at("bark_reflectance").get<double>()});
  }
  return material;
}

json json_of(const Prototype& prototype) {
  return {{"name", prototype.name},
          {"materials", prototype.materials},
          {"stated_dbh_m", prototype.stated_dbh_m},
          {"foliage_elements", prototype.foliage.size()},
          {"wood_segments", prototype.wood.size()},
          {"wood_triangles", prototype.wood_mesh.size()}};
}

Prototype prototype_from(const json& text) {
  Prototype prototype;
  prototype.name = text.at("name").get<std::string>();
  prototype.materials = text.at("materials").get<std::vector<std::string>>();
  prototype.stated_dbh_m = text.at("stated_dbh_m").get<double>();
  return prototype;
}

PrototypeCounts counts_from(const json& text) {
  return {text.at("foliage_elements").get<std::uint64_t>(), text.at("wood_segments").get<std::uint64_t>(),
          text.at("wood_triangles").get<std::uint64_t>()};
}

json json_of(const Terrain& terrain) {
  return {{"elevation_m", terrain.elevation_m},
          {"slope_rad", terrain.slope_rad},
          {"aspect_rad", terrain.aspect_rad}};
}

json json_of(const Period& period) {
  return {{"origin_x_m", period.origin_m.x},
          {"origin_y_m", period.origin_m.y},
          {"size_x_m", period.size_m.x},
          {"size_y_m", period.size_m.y}};
}

Period period_from(const json& text) {
  return {{text.at("origin_x_m").get<double>(), text.at("origin_y_m").get<double>()},
          {text.at("size_x_m").get<double>(), text.at("size_y_m").get<double>()}};
}

Terrain terrain_from(const json& text) {
  return {text.at("elevation_m").get<double>(), text.at("slope_rad").get<double>(),
          text.at("aspect_rad").get<double>()};
}

}  // namespace

std::string text_of_description(const Forest& forest) {
  json text = {{"format", kFormat},
               {"name", forest.name},
               {"content_sha256", content_hash(forest)},
               {"instances", forest.instances.size()},
               {"terrain", json_of(forest.terrain)},
               {"materials", json::array()},
               {"prototypes", json::array()}};
  for (const Material& material : forest.materials) text["materials"].push_back(json_of(material));
  for (const Prototype& prototype : forest.prototypes) text["prototypes"].push_back(json_of(prototype));
  if (forest.period) text["period"] = json_of(*forest.period);
  try {
    return text.dump(1);
  } catch (const json::type_error&) {
    throw_invalid("forest " + forest.name, "a name holds bytes that are not UTF-8", "write names in UTF-8");
  }
}

ForestDescription description_from_text(const std::string& text) {
  const json read = json::parse(text);
  if (read.at("format").get<int>() != kFormat) {
    throw std::runtime_error("its format is " + read.at("format").dump() + ", this program reads " +
                             std::to_string(kFormat));
  }
  ForestDescription description;
  Forest& forest = description.forest;
  forest.name = read.at("name").get<std::string>();
  for (const json& material : read.at("materials")) forest.materials.push_back(material_from(material));
  for (const json& prototype : read.at("prototypes")) {
    forest.prototypes.push_back(prototype_from(prototype));
    description.counts.push_back(counts_from(prototype));
  }
  forest.terrain = terrain_from(read.at("terrain"));
  if (read.contains("period")) forest.period = period_from(read.at("period"));
  description.instances = read.at("instances").get<std::uint64_t>();
  description.content_hash = read.at("content_sha256").get<std::string>();
  return description;
}

}  // namespace sunfleck
