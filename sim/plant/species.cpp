// Species allometry and the library that finds a species by any of its names.
#include "sim/plant/species.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "sim/base/error.h"
#include "sim/base/vec.h"
#include "sim/plant/make_prototype.h"

namespace sunfleck {
namespace {

constexpr double kBreastHeight_m = 1.3;

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::vector<std::string> names_of(const Species& species) {
  std::vector<std::string> names = species.also_called;
  names.push_back(species.code);
  names.push_back(species.latin);
  for (std::string& name : names) name = lower_case(name);
  return names;
}

// "Fagus sylvatica (beech, fagus, fasy)": every name once.
std::string listed(const Species& species) {
  std::string others;
  std::set<std::string> said{lower_case(species.latin)};
  for (const std::string& name : names_of(species))
    if (said.insert(name).second) others += (others.empty() ? " (" : ", ") + name;
  return species.latin + others + (others.empty() ? "" : ")");
}

std::vector<std::filesystem::path> toml_files(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  if (failed)
    throw Error(ErrorKind::kNotFound, folder.string(), "is not a readable folder: " + failed.message(),
                "give the folder of the species files, for example configs/species");
  if (files.empty())
    throw Error(ErrorKind::kNotFound, folder.string(), "holds no species file",
                "give the folder of the species files (*.toml), for example configs/species");
  std::sort(files.begin(), files.end());
  return files;
}

// Two species under one name would make an inventory ambiguous.
void claim_names(const Species& species, const std::filesystem::path& file,
                 std::map<std::string, std::string>& owners) {
  for (const std::string& name : names_of(species)) {
    const auto [owner, is_new] = owners.emplace(name, species.latin);
    if (!is_new && owner->second != species.latin)
      throw_invalid(file.string() + ": also_called", "\"" + name + "\" already means " + owner->second,
                    "give each name to one species");
  }
}

}  // namespace

std::string to_string(TreeForm form) { return form == TreeForm::kOpenGrown ? "open" : "stand"; }

double LeafAreaLaw::at(double dbh_cm, double height_m) const {
  return a * std::pow(dbh_cm, b) * std::pow(height_m, c);
}

double Species::leaf_area_m2(double dbh_cm, double height_m) const {
  return harvested_leaf_area ? harvested_leaf_area->at(dbh_cm, height_m) : leaf_area_m2(dbh_cm);
}

double PowerLaw::at(double dbh_cm) const { return a * std::pow(dbh_cm, b); }

double HeightCurve::at(double dbh_cm) const {
  return kBreastHeight_m + (a > 0 ? a * std::pow(dbh_cm, b) : std::exp(p + q / (dbh_cm + 1.0)));
}

double FoliageTemplate::shoot_area_m2() const {
  return needles_per_m * shoot_length_m * 0.5 * kPi * needle_length_m * needle_width_m;
}

double FoliageTemplate::shoot_density_per_m() const {
  return shoot_area_m2() / (kPi * shoot_radius_m * shoot_radius_m * shoot_length_m);
}

namespace {

TreeSize open_grown_size(const Species& species, double dbh_cm) {
  if (!species.open_grown)
    throw_invalid(species.latin + ": open_grown", "nothing is known of trees that grew up alone",
                  "an [open_grown] table in its file, or the stand-grown form");
  const OpenGrown& open = *species.open_grown;
  const double height_m =
      std::min(species.height_m(dbh_cm), kBreastHeight_m + open.height_above_breast_m.at(dbh_cm));
  return {dbh_cm / 100.0, height_m, (1 - open.crown_length_ratio) * height_m, open.crown_radius.at(dbh_cm),
          species.leaf_area_m2(dbh_cm)};
}

}  // namespace

TreeSize expected_size(const Species& species, double dbh_cm, TreeForm form) {
  if (!(dbh_cm > 0.0 && dbh_cm <= 1000.0))
    throw_invalid("dbh_cm", std::to_string(dbh_cm) + " is no stem diameter",
                  "give a diameter at breast height in cm, above 0 and at most 1000");
  if (form == TreeForm::kOpenGrown) return open_grown_size(species, dbh_cm);
  return {dbh_cm / 100.0, species.height_m(dbh_cm), species.crown_base_m(dbh_cm),
          species.crown_radius_m(dbh_cm), species.leaf_area_m2(dbh_cm)};
}

SpeciesLibrary SpeciesLibrary::load(const std::filesystem::path& folder) {
  SpeciesLibrary library;
  std::map<std::string, std::string> owners;
  for (const std::filesystem::path& file : toml_files(folder)) {
    library.species_.push_back(load_species(file));
    claim_names(library.species_.back(), file, owners);
  }
  return library;
}

const Species& SpeciesLibrary::find(const std::string& name, const std::string& where) const {
  const std::string wanted = lower_case(name);
  for (const Species& species : species_) {
    const std::vector<std::string> names = names_of(species);
    if (std::find(names.begin(), names.end(), wanted) != names.end()) return species;
  }
  std::string known;
  for (const Species& species : species_) known += (known.empty() ? "" : ", ") + listed(species);
  throw_invalid(where, "unknown species \"" + name + "\"", "use one of " + known + "; or add a species file");
}

}  // namespace sunfleck
