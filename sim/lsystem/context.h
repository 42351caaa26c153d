// Contexts of rules: walks from a module towards the root (left) or towards the tips (right) of its branch
// and compares what it meets with a rule's patterns. ABOP section 1.8: on the way to the root side branches
// are skipped; on the way to the tips a branch is skipped unless the pattern asks for it by '['.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/lsystem/compiled.h"

namespace sunfleck::lsystem {

// A string in reading order with the partner of each bracket.
struct PlainView {
  const ModuleString& string;
  const std::vector<std::uint32_t>& partners;
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(string.size()); }
  std::uint16_t symbol(std::ptrdiff_t i) const { return string.symbol(static_cast<std::size_t>(i)); }
  std::span<const double> parameters(std::ptrdiff_t i) const {
    return string.parameters(static_cast<std::size_t>(i));
  }
  std::ptrdiff_t partner(std::ptrdiff_t i) const { return partners[static_cast<std::size_t>(i)]; }
};

// The same for a string that is being produced from right to left and lies reversed in memory.
struct ReversedView {
  const ModuleString& string;
  const std::vector<std::uint32_t>& partners;
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(string.size()); }
  std::size_t turned(std::ptrdiff_t i) const { return static_cast<std::size_t>(size() - 1 - i); }
  std::uint16_t symbol(std::ptrdiff_t i) const { return string.symbol(turned(i)); }
  std::span<const double> parameters(std::ptrdiff_t i) const { return string.parameters(turned(i)); }
  std::ptrdiff_t partner(std::ptrdiff_t i) const {
    return size() - 1 - static_cast<std::ptrdiff_t>(partners[turned(i)]);
  }
};

// Partners of brackets, kept up to date while a string grows at its end. `opening` is the bracket that is met
// first in the direction of growth.
class BracketPartners {
 public:
  BracketPartners(std::uint16_t opening, std::uint16_t closing) : opening_(opening), closing_(closing) {}
  void extend(const ModuleString& string);
  const std::vector<std::uint32_t>& partners() const { return partners_; }

 private:
  std::uint16_t opening_, closing_;
  std::vector<std::uint32_t> partners_, open_;
};

// True if the module symbol and number of parameters fit; then its parameters are in the pattern's slots.
inline bool bind_module(const ModulePattern& pattern, std::uint16_t symbol,
                        std::span<const double> parameters, double* slots) {
  if (symbol != pattern.symbol || parameters.size() != pattern.arity) return false;
  for (std::size_t k = 0; k < parameters.size(); ++k) slots[pattern.first_slot + k] = parameters[k];
  return true;
}

// `from`: the first place to look at (left: walking down, right: walking up).
template <class View>
bool match_left(const View& view, std::ptrdiff_t from, std::span<const ModulePattern> patterns,
                const Grammar::Compiled& grammar, double* slots);
template <class View>
bool match_right(const View& view, std::ptrdiff_t from, std::span<const ModulePattern> patterns,
                 const Grammar::Compiled& grammar, double* slots);

}  // namespace sunfleck::lsystem
