#include <cstdio>

#include "sim/lsystem/compiled.h"

namespace sunfleck::lsystem {

void ModuleString::clear() {
  symbol_.clear();
  first_.assign(1, 0);
  parameters_.clear();
}

void ModuleString::reserve(std::size_t modules, std::size_t parameters) {
  symbol_.reserve(modules);
  first_.reserve(modules + 1);
  parameters_.reserve(parameters);
}

ModuleString ModuleString::reversed() const {
  ModuleString turned;
  turned.reserve(size(), parameters_.size());
  for (std::size_t i = size(); i-- > 0;) turned.append(symbol(i), parameters(i));
  return turned;
}

std::string print_modules(const Grammar::Compiled& grammar, const ModuleString& string) {
  std::string text;
  char number[40];
  for (std::size_t i = 0; i < string.size(); ++i) {
    text += grammar.symbols.at(string.symbol(i)).name;
    const auto parameters = string.parameters(i);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      std::snprintf(number, sizeof number, "%.12g", parameters[k]);
      text += k == 0 ? '(' : ',';
      text += number;
    }
    if (!parameters.empty()) text += ')';
  }
  return text;
}

}  // namespace sunfleck::lsystem
