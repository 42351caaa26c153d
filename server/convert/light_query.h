// The small answer: chosen elements and trees of a light map.
#pragma once

#include "lighting/base/light_map.h"
#include "server/convert/limits.h"
#include "server/convert/violations.h"
#include "sim/forest/forest.h"

namespace sunfleck {

namespace v1 {
class QueryLightRequest;
class QueryLightResponse;
}  // namespace v1

// What can be said without the scene, and what needs it.
void check_query_size(const v1::QueryLightRequest& request, const Limits& limits, Violations& violations);
void check_query_places(const v1::QueryLightRequest& request, const Forest& forest, Violations& violations);

void fill_answer(const v1::QueryLightRequest& request, const LightMap& map, v1::QueryLightResponse& response);

}  // namespace sunfleck
