// The plot's outline and what stands around it, between the wire and sim. Part of forest_spec_message.h.
#pragma once

#include <cstdint>
#include <string>

#include "server/convert/limits.h"
#include "server/convert/violations.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

namespace v1 {
class ForestSpec;
}

// `trees`: of the inventory. Trees around the plot count against the limit by the area they would stand on.
void read_surroundings(const v1::ForestSpec& message, const std::string& field, std::uint64_t trees,
                       const Limits& limits, Violations& violations, ForestSpec& spec);
void fill_surroundings(const ForestSpec& spec, v1::ForestSpec& message);

}  // namespace sunfleck
