// What an inventory says against what its species can be: allometry of the species files with generous spans,
// since the point is wrong units and typing errors, not unusual trees.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "sim/base/error.h"
#include "sim/forest/inventory.h"
#include "sim/forest/tree_size.h"

namespace sunfleck {
namespace {

// A tree outside these multiples of what its diameter lets expect is worth a second look.
constexpr double kLowHeight = 0.3, kHighHeight = 2.5, kLowRadius = 0.15, kHighRadius = 4.0;

std::string text(const char* format, double a, double b) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

void check_height(const InventoryTree& tree, const Species& species,
                  std::vector<InventoryProblem>& problems) {
  if (!tree.height_m) return;
  const double expected_m = species.height_m(tree.dbh_cm), ratio = *tree.height_m / expected_m;
  if (ratio >= kLowHeight && ratio <= kHighHeight) return;
  problems.push_back(
      {Severity::kWarning, tree.where,
       text("a height of %.4g m; trees of that diameter have about %.2g m", *tree.height_m, expected_m),
       "check h_m and dbh_cm and their units"});
}

void check_crown(const InventoryTree& tree, const Species& species, std::vector<InventoryProblem>& problems) {
  try {
    const CrownShape crown = tree_crown(tree, species);
    tree_leaf_area_m2(tree, species, crown);
    double mean_m = 0;
    for (const double radius_m : crown.radius_nesw_m) mean_m += radius_m / 4;
    const double expected_m = species.crown_radius_m(tree.dbh_cm);
    if (mean_m >= kLowRadius * expected_m && mean_m <= kHighRadius * expected_m) return;
    problems.push_back(
        {Severity::kWarning, tree.where,
         text("a mean crown radius of %.3g m; trees of that diameter have about %.2g m", mean_m, expected_m),
         "check the radii and their units (radii, not diameters)"});
  } catch (const Error& error) {
    problems.push_back({Severity::kError, tree.where, error.problem(), error.remedy()});
  }
}

// One line per species name nobody knows, not one per tree.
class SpeciesCheck {
 public:
  explicit SpeciesCheck(const SpeciesLibrary& library) : library_(library) {}
  const Species* find(const InventoryTree& tree, std::vector<InventoryProblem>& problems) {
    const auto found = known_.find(tree.species);
    if (found != known_.end()) return found->second;
    try {
      return known_.emplace(tree.species, &library_.find(tree.species, tree.where + ", column species"))
          .first->second;
    } catch (const Error& error) {
      problems.push_back({Severity::kError, error.where(), error.problem(), error.remedy()});
      return known_.emplace(tree.species, nullptr).first->second;
    }
  }

 private:
  const SpeciesLibrary& library_;
  std::map<std::string, const Species*> known_;
};

}  // namespace

InventoryReading check_inventory(const std::filesystem::path& path, const SpeciesLibrary& library) {
  InventoryReading reading = examine_inventory(path);
  SpeciesCheck known(library);
  for (const InventoryTree& tree : reading.trees) {
    const Species* species = known.find(tree, reading.problems);
    if (species == nullptr) continue;
    check_height(tree, *species, reading.problems);
    check_crown(tree, *species, reading.problems);
  }
  return reading;
}

}  // namespace sunfleck
