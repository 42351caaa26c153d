// Running and printing the tables.
#include "lighting/bench/published_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace sunfleck {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// Two digits: 533, 25, 3.9, 0.062; of percentages none behind the first decimal.
std::string number(double value, const std::string& unit) {
  char text[40];
  const double size = std::abs(value);
  int decimals = size >= 10 ? 0 : 1;
  if (unit != "%" && size < 1) decimals = size >= 0.1 ? 2 : size >= 0.01 ? 3 : 4;
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string cell(const PublishedRow& row) {
  return row.column + " " + number(row.ours, row.unit) +
         (row.published ? " (" + number(*row.published, row.unit) + ")" : "") + " " + row.unit;
}

// Words of a paragraph in lines of at most 100 characters.
std::string paragraph(const std::string& head, const std::string& text) {
  std::istringstream words(head + text);
  std::string out, line = " ";
  for (std::string word; words >> word;) {
    if (line.size() + word.size() > 100) {
      out += line + "\n";
      line = "   ";
    }
    line += " " + word;
  }
  return out + line + "\n";
}

std::string table_text(const PublishedTable& table) {
  std::string text = table.title + "\n" + paragraph("ours: ", table.how) +
                     paragraph("not stated by the paper: ", table.unstated);
  std::vector<std::string> keys, lines;
  std::string scene;
  for (const PublishedRow& row : table.rows) {
    const std::string key = row.scene + '\n' + row.line;
    const auto found = std::find(keys.begin(), keys.end(), key);
    if (found != keys.end()) {
      lines[static_cast<std::size_t>(found - keys.begin())] += ";  " + cell(row);
      continue;
    }
    keys.push_back(key);
    lines.push_back((row.scene == scene ? "" : "  " + row.scene + "\n") + "    " + row.line + ":  " +
                    cell(row));
    scene = row.scene;
  }
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

std::vector<PublishedTable> run_published_tables(const PublishedPlan& plan, const RunControl& control) {
  std::vector<PublishedTable> tables;
  constexpr std::array kAll = {slab_albedo_table, slab_thickness_table, tree_table, timing_table,
                               boulanger_table};
  for (const auto table : kAll) {
    control.check();
    control.report("tables", static_cast<double>(tables.size()) / static_cast<double>(kAll.size()));
    tables.push_back(table(plan, control));
  }
  return tables;
}

std::string published_text(const std::vector<PublishedTable>& tables) {
  std::string text = "ours (the paper's)\n";
  for (const PublishedTable& table : tables) text += "\n" + table_text(table);
  return text;
}

std::string published_csv(const std::vector<PublishedTable>& tables, int threads,
                          const MachineFacts& machine) {
  std::ostringstream out;
  out << "table,scene,line,figure,unit,ours,published,how,unstated,threads,commit,date_utc,compiler,"
         "processor\n";
  for (const PublishedTable& table : tables)
    for (const PublishedRow& row : table.rows) {
      out << quoted(table.name) << ',' << quoted(row.scene) << ',' << quoted(row.line) << ','
          << quoted(row.column) << ',' << row.unit << ',' << row.ours << ',';
      if (row.published) out << *row.published;
      out << ',' << quoted(table.how) << ',' << quoted(table.unstated) << ',' << threads << ','
          << machine.commit << ',' << machine.date_utc << ',' << quoted(machine.compiler) << ','
          << quoted(machine.processor) << '\n';
    }
  return out.str();
}

}  // namespace sunfleck
