// Ids are types: an index into one table does not fit another.
#pragma once

#include <compare>
#include <cstdint>

namespace sunfleck {

template <class Tag>
struct Id {
  std::uint32_t value = 0;
  auto operator<=>(const Id&) const = default;
};

using PrototypeId = Id<struct PrototypeTag>;  // index into Forest::prototypes
using TreeId = Id<struct TreeTag>;            // number of a tree in its inventory, as the user wrote it

}  // namespace sunfleck
