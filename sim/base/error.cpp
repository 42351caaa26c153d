// Messages quote what users gave, which may be a whole binary file: they are kept to what a terminal and a
// log can show. Line ends stay: they part the entries of lists.
#include "sim/base/error.h"

#include <array>
#include <cstdio>
#include <string_view>

namespace sunfleck {
namespace {

constexpr std::size_t kMostBytes = 5000, kKeptAtEnd = 500;

bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
}
bool continues_utf8(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// The middle of a long text left out, never within a character.
std::string shortened(std::string text) {
  if (text.size() <= kMostBytes) return text;
  std::size_t head = kMostBytes - kKeptAtEnd, tail = text.size() - kKeptAtEnd;
  while (head > 0 && continues_utf8(text[head])) --head;
  while (tail < text.size() && continues_utf8(text[tail])) ++tail;
  return text.replace(head, tail - head, " [...] ");
}

// Control characters spelt: \x00.
std::string without_controls(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    std::array<char, 8> spelt{c};
    if (is_control(c)) std::snprintf(spelt.data(), spelt.size(), "\\x%02x", static_cast<unsigned>(c));
    shown += spelt.data();
  }
  return shown;
}

std::string sentence(const std::string& where, const std::string& problem, const std::string& remedy) {
  std::string text = where.empty() ? problem : where + ": " + problem;
  if (!remedy.empty()) text += " (" + remedy + ")";
  return text;
}

// The parts made fit to be shown, and the sentence of them.
std::string settle(std::string& where, std::string& problem, std::string& remedy) {
  for (std::string* part : {&where, &problem, &remedy}) *part = shortened(without_controls(*part));
  return sentence(where, problem, remedy);
}

}  // namespace

Error::Error(ErrorKind kind, std::string where, std::string problem, std::string remedy)
    : std::runtime_error(settle(where, problem, remedy)),
      kind_(kind),
      where_(std::move(where)),
      problem_(std::move(problem)),
      remedy_(std::move(remedy)) {}

void throw_invalid(std::string where, std::string problem, std::string remedy) {
  throw Error(ErrorKind::kInvalidInput, std::move(where), std::move(problem), std::move(remedy));
}

void throw_cancelled() { throw Error(ErrorKind::kCancelled, "", "stopped on request"); }

}  // namespace sunfleck
