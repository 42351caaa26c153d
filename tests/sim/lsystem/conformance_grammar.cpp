#include "conformance_grammar.h"

#include <map>
#include <set>

namespace sunfleck::lsystem {
namespace {

const std::string kTurtleCharacters = "FfGg+-&^\\/|$[]{}.!_';,%~";

// Finds single-character symbols outside parentheses and counts their parameters.
void collect(const std::string& modules, std::map<char, int>& arity) {
  int depth = 0;
  char last = 0;
  for (const char c : modules) {
    if (c == '(' && depth++ == 0) arity[last] = 1;
    if (c == ',' && depth == 1) ++arity[last];
    if (depth == 0 && c != ' ') arity.emplace(last = c, 0);
    if (c == ')') --depth;
  }
}

std::string rule_text(const nlohmann::json& rule) {
  std::string text;
  if (rule.contains("left")) text += rule["left"].get<std::string>() + " < ";
  text += rule["predecessor"].get<std::string>();
  if (rule.contains("right")) text += " > " + rule["right"].get<std::string>();
  if (rule.contains("condition")) text += " : " + rule["condition"].get<std::string>();
  return text + " --> " + rule["successor"].get<std::string>() + "\n";
}

std::string spaced(const std::string& characters) {
  std::string text;
  for (const char c : characters) text += std::string(" ") + c;
  return text;
}

std::string declarations(const nlohmann::json& golden_case) {
  std::map<char, int> arity;
  collect(golden_case["axiom"], arity);
  for (const auto& rule : golden_case["rules"])
    for (const char* part : {"left", "predecessor", "right", "successor"})
      if (rule.contains(part)) collect(rule[part], arity);
  std::string text = "symbols:";
  for (const auto& [symbol, count] : arity)
    if (kTurtleCharacters.find(symbol) == std::string::npos)
      text += std::string(" ") + symbol + "(" + std::to_string(count) + ")";
  return text + "\n";
}

}  // namespace

std::string grammar_text(const nlohmann::json& golden_case) {
  std::string text;
  if (golden_case.contains("constants"))
    for (const auto& [name, value] : golden_case["constants"].items())
      text += "#define " + name + " " + value.dump() + "\n";
  text += declarations(golden_case);
  if (golden_case["draw_symbols"] != "F") text += "draw:" + spaced(golden_case["draw_symbols"]) + "\n";
  if (golden_case.contains("ignore")) text += "ignore:" + spaced(golden_case["ignore"]) + "\n";
  text += "angle: " + golden_case["angle_deg"].dump() + "\nstep: " + golden_case["step"].dump() + "\n";
  text += "steps: " + golden_case["n"].dump() + "\n";
  text += "axiom: " + golden_case["axiom"].get<std::string>() + "\n";
  for (const auto& rule : golden_case["rules"]) text += rule_text(rule);
  return text;
}

}  // namespace sunfleck::lsystem
