// The walk over source text that all parsers of grammars share.
#include <cctype>

#include "sim/base/error.h"
#include "sim/lsystem/expression_parser.h"

namespace sunfleck::lsystem {

void Cursor::skip_blanks() {
  while (!at_end() && std::isspace(static_cast<unsigned char>(peek()))) ++position;
}

bool Cursor::accept(std::string_view token) {
  skip_blanks();
  if (text.substr(position, token.size()) != token) return false;
  position += token.size();
  return true;
}

void Cursor::expect(std::string_view token, const char* remedy) {
  if (!accept(token)) fail("expected '" + std::string(token) + "'", remedy);
}

std::string Cursor::identifier() {
  skip_blanks();
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
  const std::size_t begin = position;
  while (!at_end() &&
         (letter(peek()) || (position > begin && std::isdigit(static_cast<unsigned char>(peek())))))
    ++position;
  return std::string(text.substr(begin, position - begin));
}

void Cursor::fail(const std::string& problem, const std::string& remedy) const {
  const std::string rest(text.substr(std::min(position, text.size()), 24));
  throw_invalid(
      where,
      problem + (rest.empty() ? " at the end of `" : " before `" + rest + "` in `") + std::string(text) + "`",
      remedy);
}

}  // namespace sunfleck::lsystem
