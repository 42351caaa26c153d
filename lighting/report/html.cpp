#include "lighting/report/html.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "sim/base/contract.h"
#include "sim/base/error.h"

namespace sunfleck::html {
namespace {

constexpr char kReplacement[] = "\xEF\xBF\xBD";

// Bytes of the UTF-8 character that starts here; 0 where none does.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool surrogate = first == 0xED && byte(1) > 0x9F, beyond = first == 0xF4 && byte(1) > 0x8F;
  return overlong || surrogate || beyond ? 0 : length;
}

std::string entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return std::string(1, c);
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const auto first = static_cast<unsigned char>(text[0]);
    const bool control = (first < 0x20 && first != '\t' && first != '\n') || first == 0x7F;
    if (length == 0 || control)
      out += kReplacement;
    else if (length == 1)
      out += entity(text[0]);
    else
      out += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out;
}

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "&ndash;";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  const bool is_zero = std::string(text).find_first_of("123456789") == std::string::npos;
  if (text[0] != '-') return text;
  return (is_zero ? "" : "&minus;") + std::string(text + 1);
}

std::string number_with_error(double value, double error, int digits, double factor) {
  std::string out = number(factor * value, digits);
  if (!std::isfinite(value) || !std::isfinite(error) || error <= 0) return out;
  // Two significant digits of the error at least, so that a small one does not read as none.
  const double shown = factor * error;
  const int needed = std::clamp(static_cast<int>(std::ceil(-std::log10(shown))), digits, digits + 2);
  return out + "&nbsp;&plusmn;&nbsp;" + number(shown, needed);
}

std::string count(std::size_t things) {
  std::string text = std::to_string(things);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, "&thinsp;");
  return text;
}

std::string figure(double value) {
  if (!std::isfinite(value)) return "&ndash;";
  if (value == 0) return "0";
  const int whole = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  std::string text = number(value, std::clamp(4 - whole, 0, 6));
  const std::size_t point = text.find('.');
  std::size_t at = (point == std::string::npos ? text.size() : point);
  const std::size_t first = text.find_first_of("0123456789");
  while (at > first + 3) text.insert(at -= 3, "&thinsp;");
  return text;
}

void Table::row(std::vector<std::string> cells) {
  SUNFLECK_EXPECTS(cells.size() == header_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::cell(const char* tag, std::size_t column, const std::string& content) const {
  return "<" + std::string(tag) + (column < text_columns_ ? " class=\"l\">" : ">") + content + "</" + tag +
         ">";
}

std::string Table::text(const std::string& caption) const {
  std::string out = "<div class=\"scroll\"><table><caption>" + caption + "</caption><thead><tr>";
  for (std::size_t c = 0; c < header_.size(); ++c) out += cell("th", c, header_[c]);
  out += "</tr></thead><tbody>\n";
  for (const auto& row : rows_) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) out += cell("td", c, row[c]);
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string facts(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::string out = "<dl class=\"facts\">\n";
  for (const auto& [what, value] : rows) out += "<dt>" + what + "</dt><dd>" + value + "</dd>\n";
  return out + "</dl>\n";
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string image(const std::filesystem::path& file, const std::string& alt, const std::string& css_class) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(ErrorKind::kInputOutput, file.string(), "cannot be read back");
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const char* type = file.extension() == ".svg" ? "image/svg+xml" : "image/png";
  return "<img" + (css_class.empty() ? "" : " class=\"" + css_class + "\"") + " alt=\"" + escaped(alt) +
         "\" src=\"data:" + type + ";base64," + base64(bytes) + "\">";
}

}  // namespace sunfleck::html
