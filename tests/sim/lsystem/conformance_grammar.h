// Writes a case of tests/golden/lsystem.json in our grammar language.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sunfleck::lsystem {

// Single-character symbols become declarations with the arity they are used with; rules, ignored symbols and
// constants are copied.
std::string grammar_text(const nlohmann::json& golden_case);

}  // namespace sunfleck::lsystem
