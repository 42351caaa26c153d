// How crowns of measured trees are filled, and the trees nobody measured under them, between the wire and
// sim. Part of forest_spec_message.h.
#pragma once

#include <cstdint>
#include <string>

#include "server/convert/violations.h"
#include "sim/forest/forest_spec.h"

namespace sunfleck {

namespace v1 {
class ForestSpec;
}

// Ranges are those of scene files.
void read_crowns(const v1::ForestSpec& message, const std::string& field, Violations& violations,
                 ForestSpec& spec);
void fill_crowns(const ForestSpec& spec, v1::ForestSpec& message);

// About how many foliage elements the crowns of `trees` trees will have, rather too many: where elements have
// an area, 0.2 m2 of leaf per square centimetre of DBH and tree (0.13 seen in measured stands).
double predicted_crown_elements(const ForestSpec& spec, std::uint64_t trees);

}  // namespace sunfleck
