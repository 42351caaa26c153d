// Writes CSV: shortest decimal text that reads back to the same number. A value that is not finite is a
// broken contract and leaves no file.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "sim/base/contract.h"
#include "sim/base/pending_file.h"

namespace sunfleck {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// Collects fields in a buffer and hands it to the file in large pieces.
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& actual, std::filesystem::path shown)
      : shown_(std::move(shown)), file_(std::fopen(actual.c_str(), "wb")) {
    if (!file_) throw_cannot_write(shown_, "opening failed");
  }

  void text(std::string_view value) { buffer_.append(value).push_back(','); }

  template <class Number>
  void number(Number value) {
    if constexpr (std::is_floating_point_v<Number>) SUNFLECK_EXPECTS(std::isfinite(value));
    std::array<char, 40> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

  void end_line() {
    buffer_.back() = '\n';  // in place of the last comma
    if (buffer_.size() > kPiece) flush();
  }

  void close() {
    flush();
    if (std::fclose(file_.release()) != 0) throw_cannot_write(shown_, "closing failed");
  }

 private:
  static constexpr std::size_t kPiece = 1 << 20;

  void flush() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size())
      throw_cannot_write(shown_, "writing failed");
    buffer_.clear();
  }

  std::filesystem::path shown_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::string buffer_;
};

// RFC 4180: quotes around a name that holds a comma, quote or line break.
inline std::string csv_quoted(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string text = "\"";
  for (const char c : name) text.append(c == '"' ? 2 : 1, c);
  return text + '"';
}

// The whole file or none.
template <class WriteLines>
void write_csv(const std::filesystem::path& path, const WriteLines& write_lines) {
  PendingFile pending(path);
  CsvWriter csv(pending.path(), path);
  write_lines(csv);
  csv.close();
  pending.commit();
}

}  // namespace sunfleck
