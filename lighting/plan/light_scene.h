// What estimators and `auto` get to know of the forest they work on: itself, its numbering, its identity, and
// the store of things prepared for it before.
#pragma once

#include <string>

#include "lighting/base/prepared_cache.h"
#include "sim/forest/forest.h"

namespace sunfleck {

struct LightScene {
  const Forest& forest;
  const ForestIndex& index;
  const std::string& forest_hash;  // content_hash()
  const PreparedStore& store;
  int threads = 1;  // that work on the request
};

}  // namespace sunfleck
