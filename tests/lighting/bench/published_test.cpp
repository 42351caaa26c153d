// The papers' figures beside ours: complete, finite, and the slab's as the formula sheet has them.
#include "lighting/bench/published_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

double figure(const PublishedTable& table, const std::string& line, const std::string& column) {
  for (const PublishedRow& row : table.rows)
    if (row.line == line && row.column == column) return row.ours;
  ADD_FAILURE() << "no " << column << " in " << line;
  return NAN;
}

// Recomputed apart, by discrete ordinates, for the sheet behind lighting/slab: .5 and .1 % at albedo .5, 6.2
// and 5.7 % at .99 (g = 0), 7.2 and 6.4 % (g = .5). Half a digit of the sheet, and .1 for the 8 directions of
// the quick run.
TEST(PublishedSlab, IsWhatTheSheetHas) {
  const PublishedTable table = slab_albedo_table({.quick = true}, {});
  EXPECT_EQ(table.rows.size(), 30u);
  EXPECT_NEAR(figure(table, "albedo 0.50, g  0.0", "S"), 0.5, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.50, g  0.0", "R"), 0.1, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.99, g  0.0", "S"), 6.2, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.99, g  0.0", "R"), 5.7, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.99, g  0.5", "S"), 7.2, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.99, g  0.5", "R"), 6.4, 0.15);
  // The metric flatters: scored on scattered light, S is off by 30 to 53 % and R by 7 to 46 %.
  for (const PublishedRow& row : table.rows) {
    if (row.column == "S, scattered light") {
      EXPECT_GT(row.ours, 25) << row.line;
    } else if (row.column == "R, scattered light") {
      EXPECT_GT(row.ours, 5) << row.line;
    }
  }
}

// The sheet: .1 and .2 % at albedo .5, 4.1 and 4.2 % at .99. Allowed as above.
TEST(PublishedSlab, HardlyDependsOnItsThickness) {
  const PublishedTable table = slab_thickness_table({.quick = true}, {});
  EXPECT_EQ(table.rows.size(), 8u);
  EXPECT_NEAR(figure(table, "albedo 0.50", "no end"), 0.1, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.50", "thickness 5"), 0.2, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.99", "no end"), 4.1, 0.15);
  EXPECT_NEAR(figure(table, "albedo 0.99", "thickness 5"), 4.2, 0.15);
}

TEST(PublishedTables, AreCompleteAndSayWhatIsOpen) {
  PublishedPlan plan{.quick = true, .repeats = 1};
  const std::vector<PublishedTable> tables = run_published_tables(plan, {});
  ASSERT_EQ(tables.size(), 5u);
  std::set<std::string> names;
  std::size_t rows = 0, published = 0;
  for (const PublishedTable& table : tables) {
    names.insert(table.name);
    EXPECT_FALSE(table.how.empty() || table.unstated.empty() || table.rows.empty()) << table.name;
    for (const PublishedRow& row : table.rows) {
      EXPECT_TRUE(std::isfinite(row.ours)) << table.name << ", " << row.line << ", " << row.column;
      EXPECT_FALSE(row.scene.empty() || row.line.empty() || row.column.empty() || row.unit.empty());
      EXPECT_TRUE(row.unit == "%" || row.ours > 0) << row.line;
      ++rows;
      published += row.published.has_value();
    }
  }
  EXPECT_EQ(names.size(), 5u);
  EXPECT_GT(published, rows / 3);
  const std::string csv = published_csv(tables, 1, machine_facts());
  EXPECT_EQ(std::ranges::count(csv, '\n'), static_cast<std::ptrdiff_t>(rows + 1));
  const std::string text = published_text(tables);
  for (const PublishedTable& table : tables) EXPECT_NE(text.find(table.title), std::string::npos);
  EXPECT_NE(text.find("(6.2)"), std::string::npos);
}

TEST(PublishedTables, StopWhenAsked) {
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(run_published_tables({.quick = true}, {.stop = source.get_token(), .progress = {}}), Error);
}

}  // namespace
}  // namespace sunfleck
