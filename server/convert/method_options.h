// Knobs of the methods between the wire and lighting. Part of light_spec_message.h.
#pragma once

#include <string>

#include "lighting/plan/light_request.h"
#include "server/convert/violations.h"

namespace sunfleck {

namespace v1 {
class LightSpec;
}

// Ranges are those of scene files and of the options' own checks.
void read_method_options(const v1::LightSpec& message, const std::string& field, Violations& violations,
                         LightRequest& request);
void fill_method_options(const LightRequest& request, v1::LightSpec& message);

}  // namespace sunfleck
