#include "sim/plant/text_file.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostBytes = std::size_t{4} << 30;
constexpr std::string_view kBlanks = " \t\r\v\f";

struct GzCloser {
  void operator()(gzFile_s* file) const { gzclose(file); }
};
using GzHandle = std::unique_ptr<gzFile_s, GzCloser>;

GzHandle open_file(const std::filesystem::path& path) {
  if (std::error_code failed; std::filesystem::is_directory(path, failed))
    throw Error(ErrorKind::kNotFound, path.string(), "is a folder, not a file",
                "give the path of a file in it");
  GzHandle file(gzopen(path.c_str(), "rb"));
  if (!file)
    throw Error(ErrorKind::kNotFound, path.string(), "there is no such readable file", "check the path");
  gzbuffer(file.get(), 1u << 18);
  return file;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
  const GzHandle file = open_file(path);
  std::string content;
  for (;;) {
    constexpr unsigned kBlock = 1u << 20;
    const std::size_t size = content.size();
    content.resize(size + kBlock);
    const int got = gzread(file.get(), content.data() + size, kBlock);
    int status = Z_OK;
    const char* message = gzerror(file.get(), &status);
    if (got < 0 || (status != Z_OK && status != Z_STREAM_END))
      throw Error(ErrorKind::kInputOutput, path.string(),
                  std::string("cannot be read to its end: ") + message,
                  "the file is truncated or damaged: fetch it again");
    content.resize(size + static_cast<std::size_t>(got));
    if (got == 0) return content;
    if (content.size() > kMostBytes)
      throw Error(ErrorKind::kLimitExceeded, path.string(), "is larger than 4 GiB", "split it");
  }
}

bool LineReader::next() {
  while (position_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line_ = text_.substr(position_, end - position_);
    line_ = trimmed(line_.substr(0, line_.find(comment_)));
    position_ = end + 1;
    ++number_;
    if (!line_.empty()) return true;
  }
  return false;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
}

double parse_number(std::string_view word, const std::string& where) {
  const std::string_view digits = without_plus(word);
  double value = 0.0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (failure != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
    throw_invalid(where, "\"" + std::string(word.substr(0, 40)) + "\" is not a finite number",
                  "write a number such as 1.25 or -3e-2");
  return value;
}

std::int64_t parse_integer(std::string_view word, const std::string& where) {
  const std::string_view digits = without_plus(word);
  std::int64_t value = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (failure != std::errc{} || end != digits.data() + digits.size())
    throw_invalid(where, "\"" + std::string(word.substr(0, 40)) + "\" is not an integer",
                  "write a whole number");
  return value;
}

}  // namespace sunfleck
