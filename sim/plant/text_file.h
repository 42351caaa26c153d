// A whole text file in memory (plain or gzip), its lines with numbers, and numbers in its lines.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

// The content, unpacked if it is gzip. Throws Error: kNotFound, kInputOutput (truncated, damaged),
// kLimitExceeded beyond 4 GiB.
std::string read_text_file(const std::filesystem::path& path);

// Walks the lines of a text. Blank lines and the part after `comment` are passed over; CR before LF is cut
// off.
class LineReader {
 public:
  LineReader(std::string_view text, std::string file, char comment = '#')
      : text_(text), file_(std::move(file)), comment_(comment) {}
  bool next();  // false at the end
  std::string_view line() const { return line_; }
  std::string where() const { return file_ + ":" + std::to_string(number_); }  // "file:line"
  std::uint32_t number() const { return static_cast<std::uint32_t>(number_); }
  std::size_t position() const { return position_; }  // just after the line

 private:
  std::string_view text_, line_;
  std::string file_;
  char comment_;
  std::size_t position_ = 0, number_ = 0;
};

// Words between blanks.
void split_words(std::string_view line, std::vector<std::string_view>& words);

// A finite number, or an error at `where`.
double parse_number(std::string_view word, const std::string& where);
std::int64_t parse_integer(std::string_view word, const std::string& where);

}  // namespace sunfleck
