// A grammar after parsing: flat tables that derivation, ageing and interpretation read and never change.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim/base/vec.h"
#include "sim/lsystem/expression.h"
#include "sim/lsystem/lsystem.h"
#include "sim/lsystem/symbols.h"

namespace sunfleck::lsystem {

inline constexpr int kMaxSlots = 64;       // parameters and locals of one rule
inline constexpr int kMaxParameters = 32;  // of one module
inline constexpr int kMaxDepth = 2000;     // of decomposition and interpretation

// A module on a left-hand side; its parameters go to consecutive slots.
struct ModulePattern {
  std::uint16_t symbol;
  std::uint16_t arity;
  std::uint16_t first_slot;
};

struct SuccessorModule {
  std::uint16_t symbol;
  std::uint16_t parameter_count;
  std::uint32_t first_program;  // into Rule::programs
};

struct Assignment {
  std::uint16_t slot;
  Program value;
};

// One production, decomposition or interpretation rule. Empty programs stand for parts that are not there.
struct Rule {
  int line = 0;
  std::string text;
  std::vector<ModulePattern> left, right;          // in reading order
  std::vector<ModulePattern> new_left, new_right;  // contexts in the string being produced
  ModulePattern predecessor{};
  std::vector<Assignment> before, after;  // the {assign} blocks round the condition
  Program condition, weight, terminal_age;
  std::vector<SuccessorModule> successor;
  std::vector<Program> programs;

  bool has_context() const {
    return !left.empty() || !right.empty() || !new_left.empty() || !new_right.empty();
  }
};

// Rules by symbol: those of `symbol` are order[first[symbol] .. first[symbol + 1]), in file order.
struct RuleTable {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> order;
  bool backward = false;      // holds a new right context: derived from right to left
  bool uses_context = false;  // needs matched brackets of the string
  bool uses_new_left = false;

  bool has(std::uint16_t symbol) const { return first[symbol] != first[symbol + 1]; }
  std::span<const std::uint32_t> rules(std::uint16_t symbol) const {
    return {order.data() + first[symbol], order.data() + first[symbol + 1]};
  }
};

enum class RuleKind : std::uint8_t { kProduction, kTimed, kDecomposition, kInterpretation };

struct System {
  std::string name;
  std::vector<RuleTable> productions;  // one per group
  RuleTable timed, decomposition, interpretation;
};

struct Grammar::Compiled {
  std::string source;
  SymbolTable symbols;
  std::map<std::string, double> constants;
  std::vector<Rule> rules;
  std::vector<System> systems;
  std::vector<std::string> groups{""};     // the first holds the rules that belong to all
  std::vector<std::uint16_t> schedule{0};  // group of each step, repeated
  std::uint16_t open = 0, close = 0;       // the symbols [ and ]
  std::vector<std::uint8_t> ignored;       // by symbol
  std::vector<std::uint8_t> timed;         // by symbol: the last parameter is an age
  bool has_queries = false, has_cut = false;
  ModuleString axiom;
  int axiom_line = 0;
  int steps = 0;
  double angle_deg = 90, step_m = 1, width_m = 1, width_increment_m = 0.1, elasticity = 0;
  Vec3 tropism{0, 0, 0};
  int decomposition_depth = 100, interpretation_depth = 1;

  // "file:line" and the rule, for messages.
  std::string where(const Rule& rule) const { return source + ":" + std::to_string(rule.line); }
};

// Symbols concatenated, parameters by %.12g.
std::string print_modules(const Grammar::Compiled& grammar, const ModuleString& string);

}  // namespace sunfleck::lsystem
