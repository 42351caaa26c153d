// A species as its file in configs/species states it: allometry, grammar, foliage, optics; each number with a
// source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/forest/forest.h"

namespace sunfleck {

struct PowerLaw {
  double a = 0, b = 0;  // value = a * dbh_cm^b
  double at(double dbh_cm) const;
};

// h = 1.3 m + exp(p + q / (dbh_cm + 1)); or, where a > 0, h = 1.3 m + a * dbh_cm^b
struct HeightCurve {
  double p = 0, q = 0;
  double a = 0, b = 0;
  double at(double dbh_cm) const;
};

// Leaf area of a harvested tree: a * dbh_cm^b * height_m^c (m2, one-sided).
struct LeafAreaLaw {
  double a = 0, b = 0, c = 0;
  double at(double dbh_cm, double height_m) const;
};

enum class LeafAngles { kSpherical, kPlanophile, kErectophile, kPlagiophile, kUniform };

enum class FoliageKind { kLeaf, kShoot };

struct FoliageTemplate {
  FoliageKind kind = FoliageKind::kLeaf;
  double leaf_length_m = 0.07, leaf_width_m = 0.05;        // leaf
  double shoot_length_m = 0.1, shoot_radius_m = 0.02;      // shoot
  double needle_length_m = 0.015, needle_width_m = 0.001;  // shoot; width of the round needle of equal girth
  double needles_per_m = 1500;                             // shoot
  std::uint32_t needles_per_fascicle = 1;                  // shoot; tufts from 6 on
  bool needles_combed = false;                             // shoot; into its plane, as in fir
  LeafAngles angles = LeafAngles::kSpherical;              // of leaf normals; of shoot axes: see crown_fill.h

  // One-sided (half of the total) needle area of one template shoot, of round needles: pi/2 length * width
  // each.
  double shoot_area_m2() const;
  // That area per volume of the shoot's cylinder.
  double shoot_density_per_m() const;
};

// How a tree grew up: among others, which took the light from its lower branches, or alone.
enum class TreeForm : std::uint8_t { kStandGrown, kOpenGrown };
std::string to_string(TreeForm form);  // "stand", "open"

// What is different in trees that always stood alone.
struct OpenGrown {
  PowerLaw height_above_breast_m;  // a * dbh_cm^b above 1.3 m; never more than in a stand
  PowerLaw crown_radius;
  double crown_length_ratio = 0.9;
};

// A species in time.
struct Demography {
  double max_height_m = 40, max_age_yr = 300, maturity_age_yr = 30;
  double shade_tolerance = 3;  // 1 light-demanding to 5 shade-tolerant
  double seed_year_interval_yr = 4;
  double seedlings_per_m2 = 100;  // of canopy, in a seed year
  double seed_distance_m = 100;   // mean, exponential kernel
  double survive_to_max_age = 0.01;
};

// How well the optics are known.
enum class Confidence { kHigh, kLow };

struct Species {
  std::string code, latin;               // "fasy", "Fagus sylvatica"
  std::vector<std::string> also_called;  // names that inventories use ("abies", "beech", ...)
  HeightCurve height;
  PowerLaw crown_radius;
  double crown_length_ratio = 0.6;  // crown length / height, stand-grown
  PowerLaw foliage_mass_kg;
  double specific_leaf_area_m2_kg = 10;            // one-sided
  std::optional<LeafAreaLaw> harvested_leaf_area;  // [leaf_area], where harvests of the species are known
  std::optional<OpenGrown> open_grown;
  std::optional<Demography> demography;
  FoliageTemplate foliage;
  std::string crown_shape;                 // "ellipsoid", "cone", "paraboloid"
  std::filesystem::path grammar;           // empty: the species is known by its crown only
  std::filesystem::path grammar_in_light;  // that asks for light (sim/growth); empty: there is none
  Material material;                       // name = latin
  Confidence optics_confidence = Confidence::kLow;

  double height_m(double dbh_cm) const { return height.at(dbh_cm); }
  double crown_radius_m(double dbh_cm) const { return crown_radius.at(dbh_cm); }
  double crown_base_m(double dbh_cm) const { return (1.0 - crown_length_ratio) * height_m(dbh_cm); }
  double leaf_area_m2(double dbh_cm) const { return foliage_mass_kg.at(dbh_cm) * specific_leaf_area_m2_kg; }
  // By the law of harvested trees where there is one: knows that slender trees carry less.
  double leaf_area_m2(double dbh_cm, double height_m) const;
};

// Reads one species file; every key is read or refused.
Species load_species(const std::filesystem::path& path);

// All species of a folder, found by code, latin name or also_called (case does not matter).
class SpeciesLibrary {
 public:
  static SpeciesLibrary load(const std::filesystem::path& folder);
  // Throws Error(kInvalidInput) at `where` with the list of known names.
  const Species& find(const std::string& name, const std::string& where) const;
  const std::vector<Species>& all() const { return species_; }

 private:
  std::vector<Species> species_;
};

}  // namespace sunfleck
