// Part of a forest file: first where its trees stand and what they fill, then the prototypes that are needed.
//
// The seal over all bytes is looked for, not computed: instances and prototypes have hashes of their own,
// which are checked as they are read. What is left in the file stays unread and unchecked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/forest/forest_outline.h"
#include "sim/grid/forest_description.h"

namespace sunfleck {

struct ForestSketch {
  std::filesystem::path path;
  ForestDescription description;  // its forest has the instances, but no foliage and wood
  ForestOutline outline;
  const std::string& content_hash() const {
    return description.content_hash;
  }  // of the whole forest, as stated
};

// Nothing for files from before 2026-11, which do not state what their prototypes fill and can only be read
// whole. Throws as load_forest.
std::optional<ForestSketch> read_sketch(const std::filesystem::path& path);

// The forest with the prototypes for which `wanted` (one per prototype) is not 0; the others are empty. All
// instances stay, so that their numbers do. Throws Error(kInvalidInput) where what was read does not match
// its hash.
Forest load_prototypes(const ForestSketch& sketch, const std::vector<char>& wanted);

}  // namespace sunfleck
