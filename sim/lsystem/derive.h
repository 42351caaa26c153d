// One derivation step and one lapse of time, over flat strings.
#pragma once

#include "sim/lsystem/compiled.h"

namespace sunfleck::lsystem {

ModuleString decompose_axiom(const Grammar::Compiled& grammar, const DeriveOptions& options);
// All modules rewritten at once by the rules of the step's group; queries must have been answered.
ModuleString rewrite(const Grammar::Compiled& grammar, const ModuleString& string, int step,
                     const DeriveOptions& options, const RunControl& control);
// Ages advanced; a module that reaches its terminal age is replaced, its successors getting the rest.
ModuleString let_time_pass(const Grammar::Compiled& grammar, const ModuleString& string, double duration,
                           const DeriveOptions& options, const RunControl& control);
// Everything behind a % up to the end of its branch removed, the % included.
ModuleString without_cut_branches(const Grammar::Compiled& grammar, const ModuleString& string);
// The system (index) whose rules hold at each module; empty if there is only one.
std::vector<std::uint16_t> systems_along(const Grammar::Compiled& grammar, const ModuleString& string);

}  // namespace sunfleck::lsystem
