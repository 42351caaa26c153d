// Scenes that pictures are measured on, made from a seed by the program itself.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lighting/bench/image_errors.h"

namespace sunfleck {

struct ImageScene {
  std::string name, what;
  std::function<ImageTask(const RunControl&)> make;  // without ways
};

// bush: 1,500 leaves in a ball; beech, spruce: trees of 30 cm DBH from their grammars; firs: 80 small firs,
// 64 to 127 pixels high, as in [Meyer00] 7; far_crowns: 400 crowns of 20,000 leaves, 8 to 16 pixels high.
// PAR, sun at 35 degrees zenith and a uniform sky (bench_light). `species` is the folder of the species
// files.
std::vector<ImageScene> image_scenes(std::uint64_t seed, const std::filesystem::path& species);

// Names separated by commas; "quick": bush, beech; "all". Throws Error(kInvalidInput) listing the names.
std::vector<ImageScene> choose_image_scenes(const std::vector<ImageScene>& scenes, const std::string& names);

}  // namespace sunfleck
