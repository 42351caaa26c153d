// What links take, and the refusal where it is more than allowed.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/trace/receivers.h"

namespace sunfleck::links {

// Per prototype the instances that stand for it, in order.
std::vector<std::vector<std::uint32_t>> instances_of_prototypes(const Forest& forest);

// Bytes that are needed whatever the rays meet: links of prototypes and ground, fields of the iteration.
std::uint64_t fewest_bytes(const trace::Receivers& receivers, int links_per_face);

// Throws Error(kLimitExceeded) naming "links.links_per_face".
void check_memory(std::uint64_t bytes, int links_per_face, std::uint64_t limit_bytes);

}  // namespace sunfleck::links
