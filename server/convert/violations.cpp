// Head comment in violations.h.
#include "server/convert/violations.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sunfleck {
namespace {

std::string shown(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

// The first three, and how many there are besides: the full list travels as details.
std::string summary(const std::vector<Violation>& violations) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, violations.size()); ++i) {
    if (i > 0) text += "; ";
    text += violations[i].field + ": " + violations[i].description;
  }
  if (violations.size() > kShown) text += "; and " + std::to_string(violations.size() - kShown) + " more";
  return text;
}

bool is_plain(char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7f; }

}  // namespace

void Violations::add(std::string field, std::string description) {
  all_.push_back({std::move(field), std::move(description)});
}

bool Violations::number(const std::string& field, double value, double lo, double hi) {
  if (value >= lo && value <= hi) return true;
  add(field, "must be in [" + shown(lo) + ", " + shown(hi) + "], got " + shown(value));
  return false;
}

bool Violations::above(const std::string& field, double value, double lo, double hi) {
  if (value > lo && value <= hi) return true;
  add(field, "must be in (" + shown(lo) + ", " + shown(hi) + "], got " + shown(value));
  return false;
}

bool Violations::integer(const std::string& field, std::int64_t value, std::int64_t lo, std::int64_t hi) {
  if (value >= lo && value <= hi) return true;
  add(field,
      "must be in [" + std::to_string(lo) + ", " + std::to_string(hi) + "], got " + std::to_string(value));
  return false;
}

bool Violations::count(const std::string& field, std::size_t value, std::size_t lo, std::size_t hi) {
  if (value >= lo && value <= hi) return true;
  add(field, "must have " + std::to_string(lo) + " to " + std::to_string(hi) + " entries, got " +
                 std::to_string(value));
  return false;
}

bool Violations::text(const std::string& field, std::string_view value, std::size_t longest) {
  if (value.empty()) {
    add(field, "must not be empty");
  } else if (value.size() > longest) {
    add(field,
        "must have at most " + std::to_string(longest) + " bytes, got " + std::to_string(value.size()));
  } else if (!std::all_of(value.begin(), value.end(), is_plain) ||
             value.find_first_of("/\\") != std::string_view::npos) {
    add(field, "must have no control characters and no slashes, got '" + clipped(value) + "'");
  } else {
    return true;
  }
  return false;
}

void Violations::refuse_if_any() const {
  if (!all_.empty()) throw InvalidRequest(all_);
}

InvalidRequest::InvalidRequest(std::vector<Violation> violations)
    : std::runtime_error(summary(violations)), violations_(std::move(violations)) {}

std::string at(const std::string& field, std::size_t index) {
  return field + "[" + std::to_string(index) + "]";
}

std::string clipped(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown_text(text.substr(0, kLongest));
  // Bytes of a UTF-8 letter that was cut, and control characters, would make the answer unreadable.
  for (char& c : shown_text) c = is_plain(c) && static_cast<unsigned char>(c) < 0x80 ? c : '?';
  if (text.size() > kLongest) shown_text += "...";
  return shown_text;
}

}  // namespace sunfleck
