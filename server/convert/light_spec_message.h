// Light requests between the wire and lighting.
#pragma once

#include <set>
#include <string>

#include "lighting/plan/light_request.h"
#include "server/convert/limits.h"
#include "server/convert/violations.h"

namespace sunfleck {

namespace v1 {
class LightSpec;
class OpticsOverride;
enum SkyModel : int;
}  // namespace v1

// Checks every field; what is wrong is added to `violations` with paths that start with `field`.
LightRequest light_request_from_message(const v1::LightSpec& message, const std::string& field,
                                        const Limits& limits, Violations& violations);
void fill_message(const LightRequest& request, v1::LightSpec& message);

// `bands`: those the override may name.
OpticsOverride override_from_message(const v1::OpticsOverride& message, const std::string& field,
                                     const std::set<std::string>& bands, Violations& violations);
void fill_message(const OpticsOverride& from, v1::OpticsOverride& to);

v1::SkyModel message_sky(SkyModel sky);

// The same for the same answer: a hash of everything in the request.
std::string request_key(const LightRequest& request);

}  // namespace sunfleck
