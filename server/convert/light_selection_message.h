// The trees an answer is wanted for, between the wire and lighting. Part of light_spec_message.h.
#pragma once

#include <string>

#include "lighting/plan/selection.h"
#include "server/convert/limits.h"
#include "server/convert/violations.h"

namespace sunfleck {

namespace v1 {
class LightSpec;
}

// What can be said without the scene.
void read_selection(const v1::LightSpec& message, const std::string& field, const Limits& limits,
                    Violations& violations, Selection& selection);
// What needs it: trees that are not there, or have no leaves.
void check_selection(const Selection& selection, const Forest& forest, const std::string& field,
                     Violations& violations);
// For pictures, which show all trees.
void refuse_selection(const Selection& selection, const std::string& field, Violations& violations);

void fill_selection(const Selection& selection, v1::LightSpec& message);

}  // namespace sunfleck
