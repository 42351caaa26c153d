#include "sim/lsystem/symbols.h"

#include <algorithm>

namespace sunfleck::lsystem {
namespace {

struct Builtin {
  const char* name;
  TurtleOp op;
};
constexpr Builtin kBuiltins[] = {
    {"F", TurtleOp::kDraw},          {"G", TurtleOp::kDrawNoVertex},
    {"f", TurtleOp::kMove},          {"g", TurtleOp::kMoveNoVertex},
    {"+", TurtleOp::kTurnLeft},      {"-", TurtleOp::kTurnRight},
    {"&", TurtleOp::kPitchDown},     {"^", TurtleOp::kPitchUp},
    {"\\", TurtleOp::kRollLeft},     {"/", TurtleOp::kRollRight},
    {"|", TurtleOp::kTurnAround},    {"$", TurtleOp::kLevel},
    {"[", TurtleOp::kPush},          {"]", TurtleOp::kPop},
    {"{", TurtleOp::kPolygonBegin},  {"}", TurtleOp::kPolygonEnd},
    {".", TurtleOp::kPolygonVertex}, {"!", TurtleOp::kWidth},
    {"_", TurtleOp::kWidthUp},       {"'", TurtleOp::kColourUp},
    {";", TurtleOp::kColourUp},      {",", TurtleOp::kColourDown},
    {"%", TurtleOp::kCut},           {"~", TurtleOp::kSurface},
    {"@O", TurtleOp::kOrgan},        {"@o", TurtleOp::kOrgan},
    {"@T", TurtleOp::kElasticity},   {"@begin", TurtleOp::kSystemBegin},
    {"@end", TurtleOp::kSystemEnd},  {"?P", TurtleOp::kQueryPosition},
    {"?H", TurtleOp::kQueryHeading}, {"?U", TurtleOp::kQueryUp},
    {"?L", TurtleOp::kQueryLeft},    {"?E", TurtleOp::kEnvironment},
};

}  // namespace

SymbolTable::SymbolTable() {
  for (const Builtin& builtin : kBuiltins) set_op(declare(builtin.name, kAnyArity), builtin.op);
}

std::uint16_t SymbolTable::declare(const std::string& name, int arity) {
  const std::uint16_t known = find(name);
  if (known != npos) {
    symbols_[known].arity = arity;
    return known;
  }
  const auto symbol = static_cast<std::uint16_t>(symbols_.size());
  symbols_.push_back({name, TurtleOp::kNone, arity});
  names_.push_back(name);
  auto& bucket = by_first_char_[static_cast<unsigned char>(name.front())];
  bucket.push_back(symbol);
  std::stable_sort(bucket.begin(), bucket.end(),
                   [&](auto a, auto b) { return names_[a].size() > names_[b].size(); });
  return symbol;
}

std::uint16_t SymbolTable::longest_match(std::string_view text) const {
  if (text.empty()) return npos;
  for (const std::uint16_t symbol : by_first_char_[static_cast<unsigned char>(text.front())])
    if (text.starts_with(names_[symbol])) return symbol;
  return npos;
}

std::uint16_t SymbolTable::find(std::string_view name) const {
  const std::uint16_t symbol = longest_match(name);
  return symbol != npos && names_[symbol] == name ? symbol : npos;
}

}  // namespace sunfleck::lsystem
