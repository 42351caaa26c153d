// The lobes of a tree, one after the other, and room for what their rays find.
#pragma once

#include <functional>

#include "lighting/links/link_row.h"
#include "sim/base/run_control.h"

namespace sunfleck::links {

// Calls visit(place) for every lobe of the tree, neighbours in space one after the other, from many threads.
using LobeVisit = std::function<void(const LobePlace&)>;
void for_each_lobe(const LoneTree& tree, int links_per_face, std::uint64_t seed, const RunControl& control,
                   const LobeVisit& visit);

// Rows without links; counts of rays and weights of all lobes.
TreeLinks empty_links(const LoneTree& tree, int links_per_face);

}  // namespace sunfleck::links
