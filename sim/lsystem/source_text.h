// Grammar text cut into statements: comments removed, indented continuation lines joined.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sunfleck::lsystem {

struct Statement {
  int line = 0;      // of its first character
  std::string text;  // trimmed
};

// Comments: /* ... */ and from # to the end of the line (#define begins a statement instead). A line that
// begins with a blank continues the statement above it.
std::vector<Statement> split_statements(std::string_view text, const std::string& source_name);

}  // namespace sunfleck::lsystem
