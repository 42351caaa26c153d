// A TOML file as plain values: every key is read or refused, every mistake names file, line and key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

// Closed range of allowed numbers; NaN and infinity are never allowed.
struct Range {
  double lo = -std::numeric_limits<double>::max();
  double hi = std::numeric_limits<double>::max();
};

// A table of a TOML document. Reading a key marks it as read; reject_unread() on the root throws for the
// first key nobody asked for, in this table and all tables below it. All throws are Error(kInvalidInput)
// whose `where` is "file:line: dotted.key" (kNotFound for a file that does not exist).
class ConfigTable {
 public:
  static ConfigTable from_file(const std::filesystem::path& path);
  static ConfigTable from_text(std::string_view text, std::string name);

  ConfigTable(ConfigTable&&) noexcept;
  ConfigTable& operator=(ConfigTable&&) noexcept;
  ~ConfigTable();

  bool has(std::string_view key) const;  // does not count as reading
  std::vector<std::string> keys() const;

  // Required values: throw if absent, of another type, or outside `range`.
  double number(std::string_view key, Range range = {}) const;
  std::int64_t integer(std::string_view key, Range range = {}) const;
  std::string text(std::string_view key) const;
  bool boolean(std::string_view key) const;
  std::vector<double> numbers(std::string_view key, Range range = {}) const;
  std::vector<std::string> texts(std::string_view key) const;
  ConfigTable table(std::string_view key) const;
  std::vector<ConfigTable> tables(std::string_view key) const;  // array of tables; absent means none

  // The same with a default for an absent key.
  double number_or(std::string_view key, double fallback, Range range = {}) const;
  std::int64_t integer_or(std::string_view key, std::int64_t fallback, Range range = {}) const;
  std::string text_or(std::string_view key, std::string fallback) const;
  bool boolean_or(std::string_view key, bool fallback) const;
  std::optional<ConfigTable> table_if(std::string_view key) const;

  // One of `allowed`, or an error that lists them.
  std::string choice(std::string_view key, const std::vector<std::string>& allowed) const;
  std::string choice_or(std::string_view key, std::string fallback,
                        const std::vector<std::string>& allowed) const;

  std::string where(std::string_view key) const;  // "file:line: dotted.key"
  std::filesystem::path directory()
      const;  // of the file; empty for text. Relative paths in files start here.
  void reject_unread() const;

 private:
  struct Document;
  struct Node;
  explicit ConfigTable(std::unique_ptr<Node> node);
  std::unique_ptr<Node> node_;
};

}  // namespace sunfleck
