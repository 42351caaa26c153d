// Contracts of the core: what a function relies on and what it promises. A broken contract is a bug of ours,
// not a mistake of the user, and is thrown as ContractViolation so that a test, or a server, can report it.
#pragma once

#include <stdexcept>

namespace sunfleck {

class ContractViolation : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void report_contract_violation(const char* kind, const char* expression, const char* file,
                                            int line);

}  // namespace sunfleck

#define SUNFLECK_EXPECTS(condition) \
  ((condition) ? void(0) : ::sunfleck::report_contract_violation("expects", #condition, __FILE__, __LINE__))
#define SUNFLECK_ENSURES(condition) \
  ((condition) ? void(0) : ::sunfleck::report_contract_violation("ensures", #condition, __FILE__, __LINE__))
