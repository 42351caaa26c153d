// The symbols of a grammar: turtle commands known from the start and the names a grammar declares.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck::lsystem {

enum class TurtleOp : std::uint8_t {
  kNone,  // means nothing to the turtle
  kDraw,
  kDrawNoVertex,
  kMove,
  kMoveNoVertex,
  kTurnLeft,
  kTurnRight,
  kPitchDown,
  kPitchUp,
  kRollLeft,
  kRollRight,
  kTurnAround,
  kLevel,  // $
  kPush,
  kPop,
  kPolygonBegin,
  kPolygonEnd,
  kPolygonVertex,
  kWidth,       // ! sets, or takes one increment off
  kWidthUp,     // _ sets, or adds one increment
  kColourUp,    // ' and ;
  kColourDown,  // ,
  kCut,
  kSurface,      // ~: the next module is an organ
  kOrgan,        // declared as an organ, or @O @o
  kElasticity,   // @T(e)
  kSystemBegin,  // @begin(name)
  kSystemEnd,
  kQueryPosition,
  kQueryHeading,
  kQueryUp,
  kQueryLeft,
  kEnvironment
};

inline constexpr int kAnyArity = -1;

struct Symbol {
  std::string name;
  TurtleOp op = TurtleOp::kNone;
  int arity = kAnyArity;
};

class SymbolTable {
 public:
  SymbolTable();  // holds the turtle commands
  std::uint16_t declare(const std::string& name, int arity);
  // Longest symbol that `text` begins with, or npos.
  static constexpr std::uint16_t npos = 0xFFFF;
  std::uint16_t longest_match(std::string_view text) const;
  std::uint16_t find(std::string_view name) const;
  const Symbol& at(std::uint16_t symbol) const { return symbols_[symbol]; }
  void set_op(std::uint16_t symbol, TurtleOp op) { symbols_[symbol].op = op; }
  std::size_t size() const { return symbols_.size(); }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<Symbol> symbols_;
  std::vector<std::string> names_;
  std::array<std::vector<std::uint16_t>, 256> by_first_char_;  // longest name first
};

}  // namespace sunfleck::lsystem
