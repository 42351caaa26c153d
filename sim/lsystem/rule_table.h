// Sorts the rules of a grammar by system, kind, group and symbol.
#pragma once

#include <string>
#include <vector>

#include "sim/lsystem/compiled.h"

namespace sunfleck::lsystem {

struct RulePlace {
  RuleKind kind;
  std::size_t system, group;
};

// places[i] says where grammar.rules[i] stood. Fills systems, has_queries and has_cut. Rules of group 0 are
// part of every group.
void build_rule_tables(Grammar::Compiled& grammar, const std::vector<RulePlace>& places,
                       const std::vector<std::string>& system_names);

}  // namespace sunfleck::lsystem
