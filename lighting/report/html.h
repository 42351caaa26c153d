// Pieces of HTML: escaped text, numbers with their errors, tables, pictures inside the page.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck::html {

// &, <, >, " and ' as entities; control characters and bytes that are not UTF-8 as U+FFFD.
std::string escaped(std::string_view text);

// Fixed digits, "-" for a number that is not known; true minus sign.
std::string number(double value, int digits);
// "12.3 &#177; 0.4"; the error is left out where it is 0 or not known. Both times `factor`.
std::string number_with_error(double value, double error, int digits, double factor = 1);
// Things counted: no decimals, groups of three.
std::string count(std::size_t things);
// As many digits as a reader needs: four significant ones.
std::string figure(double value);

// One table: text in `header` and of cells is HTML (escape what users wrote).
class Table {
 public:
  // The first `text_columns` hold words and are set to the left.
  explicit Table(std::vector<std::string> header, std::size_t text_columns = 1)
      : header_(std::move(header)), text_columns_(text_columns) {}
  void row(std::vector<std::string> cells);
  std::size_t rows() const { return rows_.size(); }
  // A caption says what the table holds; long ones scroll.
  std::string text(const std::string& caption) const;

 private:
  std::string cell(const char* tag, std::size_t column, const std::string& content) const;

  std::vector<std::string> header_;
  std::size_t text_columns_;
  std::vector<std::vector<std::string>> rows_;
};

// Two columns: what and how much, without a header.
std::string facts(const std::vector<std::pair<std::string, std::string>>& rows);

std::string base64(std::string_view bytes);
// <img> with the file's bytes in it; .png or .svg. `alt` is escaped here.
std::string image(const std::filesystem::path& file, const std::string& alt,
                  const std::string& css_class = {});

}  // namespace sunfleck::html
