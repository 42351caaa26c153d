#include "sim/base/contract.h"

#include <string>

namespace sunfleck {

void report_contract_violation(const char* kind, const char* expression, const char* file, int line) {
  const std::string path(file);
  const std::size_t slash = path.find_last_of('/');
  throw ContractViolation(path.substr(slash == std::string::npos ? 0 : slash + 1) + ":" +
                          std::to_string(line) + ": " + kind + " " + expression);
}

}  // namespace sunfleck
