// Scenes by name, for the programs of this folder: those of lighting/bench/bench_scenes.h, "stand" (49
// open-grown clumped crowns on a hectare, 490,000 leaves), and crown:KIND:LEAVES:LAI:SEED with KIND one of
// sphere clumped cone shell ellipsoid.
#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <utility>

#include "lighting/bench/bench_scenes.h"
#include "sim/forest/generated_scenes.h"
#include "tests/bench/plan/plan_scenes.h"

namespace sunfleck {

inline Forest crown_named(const std::string& text) {
  std::istringstream in(text);
  std::string word, kind, leaves, lai, seed;
  for (std::string* part : {&word, &kind, &leaves, &lai, &seed}) std::getline(in, *part, ':');
  GeneratedCrown crown;
  for (const auto& [name, value] : {std::pair{"sphere", CrownKind::kSphere},
                                    {"clumped", CrownKind::kClumped},
                                    {"cone", CrownKind::kCone},
                                    {"shell", CrownKind::kShell},
                                    {"ellipsoid", CrownKind::kEllipsoid}})
    if (kind == name) crown.kind = value;
  crown.leaves = std::stoi(leaves);
  crown.crown_lai = std::stod(lai);
  crown.seed = std::stoull(seed);
  return generated_crown(crown);
}

inline Forest named_forest(const std::string& name) {
  const auto made = [&] {
    if (name == "stand") return hectare();
    if (name.starts_with("crown:")) return crown_named(name);
    const auto scenes = bench_scenes(1, std::filesystem::path(SUNFLECK_SOURCE_DIR) / "configs/species");
    return choose_scenes(scenes, name).front().make({});
  };
  Forest forest = made();
  forest.name = name;
  return forest;
}

}  // namespace sunfleck
