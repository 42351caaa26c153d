// Forest specifications between the wire and sim.
#pragma once

#include <string>

#include "server/convert/limits.h"
#include "server/convert/violations.h"
#include "sim/forest/forest_spec.h"
#include "sim/plant/species.h"

namespace sunfleck {

namespace v1 {
class ForestSpec;
}

// Checks every field; what is wrong is added to `violations` with paths that start with `field`.
ForestSpec forest_spec_from_message(const v1::ForestSpec& message, const std::string& field,
                                    const SpeciesLibrary& species, const Limits& limits,
                                    Violations& violations);
void fill_message(const ForestSpec& spec, v1::ForestSpec& message);

}  // namespace sunfleck
