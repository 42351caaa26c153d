// Reads a species file. Every table carries the source of its numbers; a file without one is refused.
#include <algorithm>

#include "sim/base/error.h"
#include "sim/config/config_table.h"
#include "sim/plant/species.h"

namespace sunfleck {
namespace {

constexpr Range kFraction{0.0, 1.0};
constexpr Range kSize_m{1e-5, 10.0};

void require_source(const ConfigTable& table, std::string_view key = "source") {
  if (table.text(key).empty())
    throw_invalid(table.where(key), "is empty", "say where the numbers come from, or that they are assumed");
}

PowerLaw read_power_law(const ConfigTable& table) {
  require_source(table);
  return {table.number("a", {1e-6, 1e3}), table.number("b", {0.0, 5.0})};
}

LeafAreaLaw read_leaf_area(const ConfigTable& table) {
  require_source(table);
  return {table.number("a", {1e-6, 1e3}), table.number("b", {0.0, 5.0}), table.number_or("c", 0, {-3, 3})};
}

HeightCurve read_height(const ConfigTable& table) {
  require_source(table);
  if (table.has("a")) return {0, 0, table.number("a", {1e-3, 100.0}), table.number("b", {0.0, 2.0})};
  return {table.number("p", {0.0, 5.0}), table.number("q", {-200.0, 0.0})};
}

LeafAngles read_angles(const ConfigTable& table) {
  require_source(table, "angles_source");
  const std::vector<std::string> names = {"spherical", "planophile", "erectophile", "plagiophile", "uniform"};
  const std::string name = table.choice("angles", names);
  return static_cast<LeafAngles>(std::find(names.begin(), names.end(), name) - names.begin());
}

FoliageTemplate read_foliage(const ConfigTable& table) {
  FoliageTemplate foliage;
  require_source(table);
  if (table.choice("kind", {"leaf", "shoot"}) == "leaf") {
    foliage.kind = FoliageKind::kLeaf;
    foliage.leaf_length_m = table.number("leaf_length_m", kSize_m);
    foliage.leaf_width_m = table.number("leaf_width_m", kSize_m);
  } else {
    foliage.kind = FoliageKind::kShoot;
    foliage.shoot_length_m = table.number("shoot_length_m", kSize_m);
    foliage.shoot_radius_m = table.number("shoot_radius_m", kSize_m);
    foliage.needle_length_m = table.number("needle_length_m", kSize_m);
    foliage.needle_width_m = table.number("needle_width_m", kSize_m);
    foliage.needles_per_m = table.number("needles_per_m", {1.0, 1e6});
    foliage.needles_per_fascicle =
        static_cast<std::uint32_t>(table.integer_or("needles_per_fascicle", 1, {1, 200}));
    foliage.needles_combed = table.boolean_or("needles_combed", false);
  }
  foliage.angles = read_angles(table);
  return foliage;
}

MaterialBand read_band(const ConfigTable& table) {
  MaterialBand band{table.text("name"), table.number("leaf_reflectance", kFraction),
                    table.number("leaf_transmittance", kFraction),
                    table.number("bark_reflectance", kFraction)};
  if (band.band.empty()) throw_invalid(table.where("name"), "is empty", "name the band, for example \"PAR\"");
  if (band.leaf_reflectance + band.leaf_transmittance > 1.0)
    throw_invalid(table.where("leaf_transmittance"), "reflectance and transmittance add up to more than 1",
                  "a leaf cannot give more light than it gets: lower one of them");
  return band;
}

void read_optics(const ConfigTable& table, Species& species) {
  require_source(table);
  require_source(table, "bark_source");
  species.optics_confidence =
      table.choice("confidence", {"high", "low"}) == "high" ? Confidence::kHigh : Confidence::kLow;
  species.material.name = species.latin;
  auto& bands = species.material.bands;
  for (const ConfigTable& each : table.tables("band")) {
    const MaterialBand band = read_band(each);
    if (std::any_of(bands.begin(), bands.end(), [&](const auto& b) { return b.band == band.band; }))
      throw_invalid(each.where("name"), "band \"" + band.band + "\" is given twice", "remove one of them");
    bands.push_back(band);
  }
  if (bands.empty())
    throw_invalid(table.where("band"), "there is no band", "add [[optics.band]] tables, for example PAR");
}

void read_crown(const ConfigTable& table, Species& species) {
  species.crown_length_ratio = table.number("length_ratio", {0.05, 1.0});
  require_source(table, "length_ratio_source");
  species.crown_shape = table.choice("shape", {"ellipsoid", "cone", "paraboloid"});
  require_source(table, "shape_source");
}

OpenGrown read_open_grown(const ConfigTable& table) {
  OpenGrown open;
  open.height_above_breast_m = read_power_law(table.table("height_above_breast"));
  open.crown_radius = read_power_law(table.table("crown_radius"));
  open.crown_length_ratio = table.number("length_ratio", {0.05, 0.99});
  require_source(table, "length_ratio_source");
  return open;
}

Demography read_demography(const ConfigTable& table) {
  require_source(table);
  Demography d;
  d.max_height_m = table.number("max_height_m", {1, 150});
  d.max_age_yr = table.number("max_age_yr", {10, 5000});
  d.maturity_age_yr = table.number("maturity_age_yr", {1, 1000});
  d.shade_tolerance = table.number("shade_tolerance", {1, 5});
  d.seed_year_interval_yr = table.number("seed_year_interval_yr", {1, 50});
  d.seedlings_per_m2 = table.number("seedlings_per_m2", {0, 1e5});
  d.seed_distance_m = table.number("seed_distance_m", {0.1, 1e5});
  d.survive_to_max_age = table.number("survive_to_max_age", kFraction);
  return d;
}

void read_names(const ConfigTable& table, Species& species) {
  species.code = table.text("code");
  species.latin = table.text("latin");
  species.also_called = table.texts("also_called");
  for (const char* key : {"code", "latin"})
    if (table.text(key).empty()) throw_invalid(table.where(key), "is empty", "name the species");
  if (table.has("grammar")) species.grammar = table.directory() / table.text("grammar");
  if (table.has("grammar_in_light"))
    species.grammar_in_light = table.directory() / table.text("grammar_in_light");
}

}  // namespace

Species load_species(const std::filesystem::path& path) {
  const ConfigTable table = ConfigTable::from_file(path);
  Species species;
  read_names(table, species);
  species.height = read_height(table.table("height"));
  species.crown_radius = read_power_law(table.table("crown_radius"));
  read_crown(table.table("crown"), species);
  species.foliage_mass_kg = read_power_law(table.table("foliage_mass"));
  const ConfigTable leaf_area = table.table("specific_leaf_area");
  require_source(leaf_area);
  species.specific_leaf_area_m2_kg = leaf_area.number("m2_per_kg", {0.1, 100.0});
  if (const auto law = table.table_if("leaf_area")) species.harvested_leaf_area = read_leaf_area(*law);
  if (const auto open = table.table_if("open_grown")) species.open_grown = read_open_grown(*open);
  if (const auto life = table.table_if("demography")) species.demography = read_demography(*life);
  species.foliage = read_foliage(table.table("foliage"));
  read_optics(table.table("optics"), species);
  table.reject_unread();
  return species;
}

}  // namespace sunfleck
