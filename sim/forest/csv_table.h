// A small CSV reader: header and fields as text, with the line each row came from.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/error.h"

namespace sunfleck {

// Fields separated by , or ; or tabs (whichever the header uses most), quoted with " ("" is a quote inside),
// lines ended by LF, CRLF or CR, a byte order mark and blank lines and lines that start with # are skipped.
// Column names do not mind case and surrounding blanks. A field does not span lines.
class CsvTable {
 public:
  // Throws Error(kInvalidInput) at "name:line": no header, two columns of one name, a row of another length,
  // an open quote.
  CsvTable(std::string_view csv, std::string name);
  // The same, but rows that cannot be read go to `bad_rows` instead of being thrown.
  CsvTable(std::string_view csv, std::string name, std::vector<Error>* bad_rows);

  std::size_t rows() const { return rows_.size(); }
  std::size_t columns() const { return header_.fields.size(); }
  const std::string& column_name(std::size_t column) const { return header_.fields[column]; }
  std::string column_names() const;                                   // "a, b, c"
  std::string header_where() const { return at_line(header_.line); }  // "name:line"
  // Index of the column, or nothing.
  std::optional<std::size_t> column(const std::string& name) const;
  // Same, but throws at the header's line with the columns there are.
  std::size_t required_column(const std::string& name) const;
  const std::string& field(std::size_t row, std::size_t column) const { return rows_[row].fields[column]; }
  std::string where(std::size_t row) const { return at_line(rows_[row].line); }  // "name:line"
  std::string where(std::size_t row, std::size_t column) const;                  // "name:line, column x"

  // A finite number within [lo, hi]; throws at where(row, column) with `expected`.
  double number(std::size_t row, std::size_t column, double lo, double hi, const std::string& expected) const;

 private:
  struct Row {
    std::size_t line;
    std::vector<std::string> fields;
  };
  std::vector<std::string> split(std::string_view line, std::size_t number) const;
  void read_header(std::string_view line, std::size_t number);
  void read_row(std::string_view line, std::size_t number);
  std::string at_line(std::size_t number) const { return name_ + ":" + std::to_string(number); }

  std::string name_;
  std::vector<Error>* bad_rows_ = nullptr;
  char separator_ = ',';
  Row header_{0, {}};
  std::vector<Row> rows_;
};

}  // namespace sunfleck
