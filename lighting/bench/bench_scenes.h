// The scenes every method is measured on, from small to large, each made from a seed by the program itself.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/base/run_control.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct BenchScene {
  std::string name, what;
  std::function<Forest(const RunControl&)> make;
};

// sphere_1500 sphere sphere_100k: leaves in a ball of crown LAI 5 (40,000 where no number is named);
// sphere_lai1 sphere_lai3 sphere_lai8; planophile erectophile: the sphere with other leaf angles; ellipsoid
// cone shell clumped; beech pine spruce: L-system trees of 30 cm DBH; layer: periodic, LAI 3; canopy: nine
// clumped crowns side by side, periodic; hectare: 100 clumped crowns of 5,000 leaves each on 100 m by 100 m,
// periodic. `species` is the folder of the species files (read only by the L-system trees).
std::vector<BenchScene> bench_scenes(std::uint64_t seed, const std::filesystem::path& species);

// Names separated by commas; "quick": sphere, clumped, beech; "all". Throws Error(kInvalidInput) listing the
// names.
std::vector<BenchScene> choose_scenes(const std::vector<BenchScene>& scenes, const std::string& names);

// One clumped crown of crown LAI 5, repeated in rows, each instance turned; the scene is periodic.
struct CrownRows {
  int count = 9, leaves = 40000;
  double radius_m = 3, spacing_m = 6;
  std::uint64_t seed = 1;
};
Forest crowns_in_rows(const CrownRows& rows);

}  // namespace sunfleck
