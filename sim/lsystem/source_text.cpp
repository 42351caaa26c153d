#include "sim/lsystem/source_text.h"

#include "sim/base/error.h"

namespace sunfleck::lsystem {
namespace {

constexpr std::string_view kDefine = "#define";

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

// Block comments become blanks; their line ends stay, so that line numbers do.
std::string without_block_comments(std::string_view text, const std::string& source_name) {
  std::string kept(text);
  int line = 1;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] == '\n') ++line;
    if (kept.compare(i, 2, "/*") != 0) continue;
    const std::size_t end = kept.find("*/", i + 2);
    if (end == kept.npos)
      throw_invalid(source_name + ":" + std::to_string(line), "a comment that never ends",
                    "close it with */");
    for (; i < end + 2; ++i) {
      if (kept[i] != '\n')
        kept[i] = ' ';
      else
        ++line;
    }
    --i;
  }
  return kept;
}

std::string without_line_comment(const std::string& line) {
  const std::size_t from = line.starts_with(kDefine) ? 1 : 0;
  return trimmed(std::string_view(line).substr(0, line.find('#', from)));
}

void add_line(std::vector<Statement>& statements, const std::string& line, int number,
              const std::string& source_name) {
  const std::string text = without_line_comment(line);
  if (text.empty()) return;
  if (line.front() != ' ' && line.front() != '\t') {
    statements.push_back({number, text});
    return;
  }
  if (statements.empty())
    throw_invalid(source_name + ":" + std::to_string(number), "an indented line that continues nothing",
                  "begin statements in the first column");
  statements.back().text += " " + text;
}

}  // namespace

std::vector<Statement> split_statements(std::string_view text, const std::string& source_name) {
  std::vector<Statement> statements;
  const std::string code = without_block_comments(text, source_name);
  int number = 1;
  for (std::size_t begin = 0; begin < code.size(); ++number) {
    const std::size_t end = std::min(code.find('\n', begin), code.size());
    add_line(statements, code.substr(begin, end - begin), number, source_name);
    begin = end + 1;
  }
  return statements;
}

}  // namespace sunfleck::lsystem
