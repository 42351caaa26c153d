// Modules and rules from text. One RuleParser per rule or module list; it collects the rule's slots.
#pragma once

#include <string>
#include <vector>

#include "sim/lsystem/compiled.h"
#include "sim/lsystem/expression_parser.h"

namespace sunfleck::lsystem {

// Names of the sub-systems, for @begin(name).
using SystemNames = std::vector<std::string>;

class RuleParser {
 public:
  RuleParser(Cursor cursor, const SymbolTable& symbols, const std::map<std::string, double>& constants,
             const SystemNames& systems);

  // The whole text as a rule `left < predecessor > right : {before} condition {after} --> successor :
  // weight`.
  Rule parse_rule(int line, RuleKind kind);
  // The text from the cursor to its end as modules whose parameters are expressions (an axiom, a successor).
  void parse_successor(Rule& rule);
  void parse_weight(Rule& rule);

 private:
  std::uint16_t parse_symbol();
  void check_arity(std::uint16_t symbol, std::size_t count);
  ModulePattern parse_pattern();
  std::vector<ModulePattern> parse_patterns();
  void parse_left_hand_side(Rule& rule);
  void parse_guards(Rule& rule, RuleKind kind);
  std::vector<Assignment> parse_assignments();
  void parse_system_name(Rule& rule);
  void parse_parameters(Rule& rule, SuccessorModule& module);
  void check_rule(const Rule& rule, RuleKind kind);
  std::uint16_t add_slot(const std::string& name);
  bool at_pattern_end();

  Cursor cursor_;
  const SymbolTable& symbols_;
  const SystemNames& systems_;
  Scope scope_;
};

}  // namespace sunfleck::lsystem
