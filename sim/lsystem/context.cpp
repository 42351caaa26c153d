#include "sim/lsystem/context.h"

namespace sunfleck::lsystem {

void BracketPartners::extend(const ModuleString& string) {
  for (std::size_t i = partners_.size(); i < string.size(); ++i) {
    partners_.push_back(0);
    if (string.symbol(i) == opening_) {
      open_.push_back(static_cast<std::uint32_t>(i));
    } else if (string.symbol(i) == closing_ && !open_.empty()) {
      partners_[i] = open_.back();
      partners_[open_.back()] = static_cast<std::uint32_t>(i);
      open_.pop_back();
    }
  }
}

template <class View>
bool match_left(const View& view, std::ptrdiff_t from, std::span<const ModulePattern> patterns,
                const Grammar::Compiled& grammar, double* slots) {
  std::ptrdiff_t i = from;
  for (std::size_t left = patterns.size(); left > 0;) {
    if (i < 0) return false;
    const std::uint16_t symbol = view.symbol(i);
    if (symbol == grammar.close) {
      i = view.partner(i) - 1;  // over a side branch
    } else if (symbol == grammar.open || grammar.ignored[symbol]) {
      --i;
    } else {
      if (!bind_module(patterns[left - 1], symbol, view.parameters(i), slots)) return false;
      --left;
      --i;
    }
  }
  return true;
}

namespace {

// Behind the ']' that ends the branch in which `i` lies; size() + 1 if there is none.
template <class View>
std::ptrdiff_t behind_branch(const View& view, std::ptrdiff_t i, const Grammar::Compiled& grammar) {
  while (i < view.size() && view.symbol(i) != grammar.close)
    i = view.symbol(i) == grammar.open ? view.partner(i) + 1 : i + 1;
  return i + 1;
}

// The next place whose module a pattern can be compared with, or -1 at the end of the branch.
template <class View>
std::ptrdiff_t next_candidate(const View& view, std::ptrdiff_t i, bool wants_branch,
                              const Grammar::Compiled& grammar) {
  while (i < view.size()) {
    const std::uint16_t symbol = view.symbol(i);
    if (symbol == grammar.close) return -1;
    if (symbol == grammar.open) {
      if (wants_branch) return i;
      i = view.partner(i) + 1;
    } else if (grammar.ignored[symbol]) {
      ++i;
    } else {
      return i;
    }
  }
  return -1;
}

}  // namespace

template <class View>
bool match_right(const View& view, std::ptrdiff_t from, std::span<const ModulePattern> patterns,
                 const Grammar::Compiled& grammar, double* slots) {
  std::ptrdiff_t i = from;
  for (const ModulePattern& pattern : patterns) {
    if (pattern.symbol == grammar.close) {
      i = behind_branch(view, i, grammar);
      if (i > view.size()) return false;
      continue;
    }
    i = next_candidate(view, i, pattern.symbol == grammar.open, grammar);
    if (i < 0 || !bind_module(pattern, view.symbol(i), view.parameters(i), slots)) return false;
    ++i;
  }
  return true;
}

template bool match_left(const PlainView&, std::ptrdiff_t, std::span<const ModulePattern>,
                         const Grammar::Compiled&, double*);
template bool match_right(const PlainView&, std::ptrdiff_t, std::span<const ModulePattern>,
                          const Grammar::Compiled&, double*);
template bool match_right(const ReversedView&, std::ptrdiff_t, std::span<const ModulePattern>,
                          const Grammar::Compiled&, double*);

}  // namespace sunfleck::lsystem
