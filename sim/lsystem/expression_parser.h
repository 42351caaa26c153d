// Text of an expression -> stack program. Precedence from weak to strong: || && (== !=) (< <= > >=) (+ -)
// (* / %) unary(- !) ^ (right to left).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sim/lsystem/expression.h"

namespace sunfleck::lsystem {

// A piece of source text with the place it came from; the parsers walk `position` over it.
struct Cursor {
  std::string_view text;
  std::string where;  // "file:line"
  std::size_t position = 0;

  bool at_end() const { return position >= text.size(); }
  char peek(std::size_t ahead = 0) const {
    return position + ahead < text.size() ? text[position + ahead] : '\0';
  }
  void skip_blanks();
  bool accept(std::string_view token);  // after blanks
  void expect(std::string_view token, const char* remedy);
  std::string identifier();  // empty if there is none here
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
};

// The names an expression may use: constants by value, parameters and locals by slot.
struct Scope {
  const std::map<std::string, double>* constants = nullptr;
  std::vector<std::string> slots;
};

// Parses the longest expression at the cursor and leaves the cursor behind it.
Program parse_expression(Cursor& cursor, const Scope& scope);

}  // namespace sunfleck::lsystem
