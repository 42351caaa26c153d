// What a .vdb file stores of a forest as text: everything but the elements, wood and instances, which are in
// its point grids.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/forest/forest_outline.h"

namespace sunfleck {

struct PrototypeCounts {
  std::uint64_t foliage = 0, wood = 0, wood_mesh = 0;
};

struct ForestDescription {
  Forest forest;  // names, materials, terrain, period; prototypes without elements, no instances
  std::vector<PrototypeCounts> counts;  // one per prototype
  std::uint64_t instances = 0;
  std::string content_hash;  // of the whole forest
  // Of files since 2026-11 only, else empty: what the prototypes fill, and hashes of the parts, so that a
  // part can be read and checked alone.
  std::vector<PrototypeOutline> outlines;
  std::vector<std::string> prototype_hashes;
  std::string instances_hash;
};

// JSON; numbers keep all their bits. Throws Error(kInvalidInput) if a name is not UTF-8.
std::string text_of_description(const Forest& forest);
// Throws std::exception for a text that text_of_description did not write.
ForestDescription description_from_text(const std::string& text);

}  // namespace sunfleck
