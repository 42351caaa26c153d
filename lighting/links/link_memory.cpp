#include "lighting/links/link_memory.h"

#include <string>

#include "sim/base/error.h"

namespace sunfleck::links {

std::vector<std::vector<std::uint32_t>> instances_of_prototypes(const Forest& forest) {
  std::vector<std::vector<std::uint32_t>> stands(forest.prototypes.size());
  for (std::uint32_t i = 0; i < forest.instances.size(); ++i)
    stands[forest.instances[i].prototype.value].push_back(i);
  return stands;
}

std::uint64_t fewest_bytes(const trace::Receivers& receivers, int links_per_face) {
  const Forest& forest = receivers.forest();
  const auto stands = instances_of_prototypes(forest);
  // A link, in a row of its face; counts and a weight for two lobes per face of a tree, counts per instance.
  const std::uint64_t per_row = 4 * static_cast<std::uint64_t>(links_per_face);
  std::uint64_t bytes = receivers.ground().count() * (per_row + 3 * 2);
  for (std::size_t p = 0; p < stands.size(); ++p) {
    if (stands[p].empty()) continue;
    const Prototype& tree = forest.prototypes[p];
    const std::uint64_t faces =
        2 * (tree.foliage.size() + trace::group_wood(tree).count() + tree.wood_mesh.size());
    bytes += faces * (per_row + 2 * (4 * 2 + 4) + stands[p].size() * 2 * 3 * 2);
  }
  // First light, its sky and ground parts, direct light, four fields of the iteration; optics per surface.
  constexpr std::uint64_t kPerFace = 8 * 4 + 8;
  return bytes + receivers.face_count() * kPerFace;
}

void check_memory(std::uint64_t bytes, int links_per_face, std::uint64_t limit_bytes) {
  if (bytes <= limit_bytes) return;
  const auto gib = [](std::uint64_t b) { return std::to_string(static_cast<double>(b) / (1ull << 30)); };
  throw Error(ErrorKind::kLimitExceeded, "links.links_per_face",
              std::to_string(links_per_face) + " links per face take " + gib(bytes) +
                  " GiB or more, over memory_limit_bytes of " + gib(limit_bytes) + " GiB",
              links_per_face > 16 ? "fewer links per face (16 or more), fewer trees or a higher limit"
                                  : "fewer trees, a higher limit or the grid method");
}

}  // namespace sunfleck::links
