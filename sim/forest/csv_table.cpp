// One pass over the text, line by line; everything that is wrong is said at its line.

#include "sim/forest/csv_table.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {

namespace {

std::string trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return std::string(text);
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string without_byte_order_mark(std::string_view csv) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return std::string(csv.starts_with(kMark) ? csv.substr(kMark.size()) : csv);
}

// Takes the next line off `rest`, without its end: LF, CRLF or CR.
std::string_view next_line(std::string_view& rest) {
  const std::size_t end = rest.find_first_of("\r\n");
  const std::string_view line = rest.substr(0, end);
  if (end == std::string_view::npos) {
    rest = {};
  } else {
    rest.remove_prefix(end + (rest.substr(end, 2) == "\r\n" ? 2 : 1));
  }
  return line;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

CsvTable::CsvTable(std::string_view csv, std::string name) : CsvTable(csv, std::move(name), nullptr) {}

CsvTable::CsvTable(std::string_view csv, std::string name, std::vector<Error>* bad_rows)
    : name_(std::move(name)), bad_rows_(bad_rows) {
  const std::string text = without_byte_order_mark(csv);
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = next_line(rest);
    const std::string content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    header_.fields.empty() ? read_header(line, number) : read_row(line, number);
  }
  if (header_.fields.empty()) throw_invalid(name_, "the table is empty", "start with a line of column names");
}

std::vector<std::string> CsvTable::split(std::string_view line, std::size_t number) const {
  std::vector<std::string> fields;
  std::string field;
  bool quoted = false, was_quoted = false;
  const auto end_field = [&] {
    fields.push_back(was_quoted ? field : trimmed(field));
    field.clear();
    was_quoted = false;
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && line.substr(i + 1, 1) == "\"") {
      field += line[++i];
    } else if (quoted && c == '"') {
      quoted = false;
    } else if (!quoted && c == '"' && trimmed(field).empty()) {
      field.clear();
      quoted = was_quoted = true;
    } else if (!quoted && c == separator_) {
      end_field();
    } else if (quoted || !was_quoted || (c != ' ' && c != '\t')) {
      field += c;
    }
  }
  if (quoted)
    throw_invalid(at_line(number), "a quote is not closed", "end the field with \" on the same line");
  end_field();
  return fields;
}

void CsvTable::read_header(std::string_view line, std::size_t number) {
  const auto count = [&](char c) { return std::count(line.begin(), line.end(), c); };
  for (const char candidate : {';', '\t'})
    if (count(candidate) > count(separator_)) separator_ = candidate;
  header_ = {number, split(line, number)};
  for (std::string& name : header_.fields) name = lower(trimmed(name));
  for (std::size_t i = 0; i < header_.fields.size(); ++i) {
    if (*column(header_.fields[i]) == i) continue;
    throw_invalid(at_line(number), "there are two columns " + header_.fields[i], "name each column once");
  }
}

void CsvTable::read_row(std::string_view line, std::size_t number) try {
  Row row{number, split(line, number)};
  if (row.fields.size() != header_.fields.size()) {
    throw_invalid(at_line(number), "the row has " + std::to_string(row.fields.size()) + " fields",
                  "the header names " + std::to_string(header_.fields.size()) + " columns");
  }
  rows_.push_back(std::move(row));
} catch (const Error& error) {
  if (bad_rows_ == nullptr) throw;
  bad_rows_->push_back(error);
}

std::string CsvTable::column_names() const { return joined(header_.fields); }

std::optional<std::size_t> CsvTable::column(const std::string& name) const {
  const auto found = std::find(header_.fields.begin(), header_.fields.end(), name);
  if (found == header_.fields.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header_.fields.begin());
}

std::size_t CsvTable::required_column(const std::string& name) const {
  if (const auto found = column(name)) return *found;
  throw_invalid(at_line(header_.line) + ", column " + name, "the column is missing",
                "the table has the columns " + joined(header_.fields));
}

std::string CsvTable::where(std::size_t row, std::size_t column) const {
  return at_line(rows_[row].line) + ", column " + header_.fields[column];
}

double CsvTable::number(std::size_t row, std::size_t column, double lo, double hi,
                        const std::string& expected) const {
  const std::string& text = field(row, column);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw_invalid(where(row, column), "'" + text + "' is not a number",
                  expected + ", with a point for decimals");
  }
  if (!(value >= lo && value <= hi)) throw_invalid(where(row, column), text + " is out of range", expected);
  return value;
}

}  // namespace sunfleck
