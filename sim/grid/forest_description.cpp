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

json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

Vec3 vector_from(const json& text) {
  return {text.at(0).get<double>(), text.at(1).get<double>(), text.at(2).get<double>()};
}

// Of a prototype without leaves or wood no bounds.
json json_of(const PrototypeOutline& outline) {
  json text = {{"reach_m", outline.reach_m}, {"longest_leaf_m", outline.longest_leaf_m}};
  if (outline.bounds.empty()) return text;
  text["lo_m"] = json_of(outline.bounds.lo);
  text["hi_m"] = json_of(outline.bounds.hi);
  return text;
}

PrototypeOutline outline_from(const json& text, const PrototypeCounts& counts) {
  PrototypeOutline outline;
  outline.reach_m = text.at("reach_m").get<double>();
  outline.longest_leaf_m = text.at("longest_leaf_m").get<double>();
  outline.foliage_elements = counts.foliage;
  if (text.contains("lo_m")) outline.bounds = {vector_from(text.at("lo_m")), vector_from(text.at("hi_m"))};
  return outline;
}

json json_of(const Prototype& prototype) {
  return {{"name", prototype.name},
          {"materials", prototype.materials},
          {"stated_dbh_m", prototype.stated_dbh_m},
          {"foliage_elements", prototype.foliage.size()},
          {"wood_segments", prototype.wood.size()},
          {"wood_triangles", prototype.wood_mesh.size()},
          {"outline", json_of(outline_of(prototype))},
          {"sha256", content_hash(prototype)}};
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
               {"instances_sha256", content_hash(forest.instances)},
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
    if (!prototype.contains("outline")) continue;
    description.outlines.push_back(outline_from(prototype.at("outline"), description.counts.back()));
    description.prototype_hashes.push_back(prototype.at("sha256").get<std::string>());
  }
  forest.terrain = terrain_from(read.at("terrain"));
  if (read.contains("period")) forest.period = period_from(read.at("period"));
  description.instances = read.at("instances").get<std::uint64_t>();
  if (read.contains("instances_sha256"))
    description.instances_hash = read.at("instances_sha256").get<std::string>();
  description.content_hash = read.at("content_sha256").get<std::string>();
  return description;
}

}  // namespace sunfleck
