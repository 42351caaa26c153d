// The order in which surfaces are worked through: neighbours in space one after the other (Morton order of
// their centres), so that their rays find the scene in the caches. Changes no result.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/trace/receivers.h"

namespace sunfleck::trace {

std::vector<std::uint32_t> visiting_order(const Receivers& receivers);

}  // namespace sunfleck::trace
