// Entries of tests/golden/light_cases.json by id.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/golden.h"

namespace sunfleck::test {

inline nlohmann::json light_case(const std::string& id) {
  const nlohmann::json all = golden("light_cases.json");
  for (const auto& c : all["cases"])
    if (c["id"] == id) return c;
  throw std::runtime_error("no light case " + id);
}

}  // namespace sunfleck::test
