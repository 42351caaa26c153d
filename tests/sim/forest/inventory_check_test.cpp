// What people's tables look like, and what is wrong with them: every problem is listed, with row, column and
// remedy.
#include <gtest/gtest.h>

#include <fstream>

#include "sim/forest/inventory.h"
#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

std::string listed(const InventoryReading& reading) {
  std::string all;
  for (const InventoryProblem& p : reading.problems)
    all += (p.severity == Severity::kError ? "error " : "warning ") + p.where + ": " + p.what + "\n";
  return all;
}

void expect_listed(const InventoryReading& reading, Severity severity, const std::string& where,
                   const std::string& what) {
  for (const InventoryProblem& p : reading.problems)
    if (p.severity == severity && p.where.find(where) != std::string::npos &&
        p.what.find(what) != std::string::npos) {
      EXPECT_FALSE(p.remedy.empty());
      return;
    }
  ADD_FAILURE() << "not listed: " << where << ": " << what << "\n" << listed(reading);
}

TEST(InventoryCheck, ListsEveryProblemAndKeepsTheGoodRows) {
  const InventoryReading reading = examine_inventory(
      "id_tree,species,x,y,dbh_cm,h_m,hbase_m\n"
      "1,beech,0,0,20,18,6\n"
      "2,beech,east,0,-5,18,6\n"
      "2,beech,5,0,20,18,19\n"
      "4,beech,5\n"
      "5,beech,9,9,25,20,8\n",
      "t.csv");
  EXPECT_EQ(reading.rows, 5u);
  EXPECT_EQ(reading.trees.size(), 2u);
  expect_listed(reading, Severity::kError, "t.csv:3, column x", "not a number");
  expect_listed(reading, Severity::kError, "t.csv:3, column dbh_cm", "out of range");
  expect_listed(reading, Severity::kError, "t.csv:4, column id_tree", "was there before");
  expect_listed(reading, Severity::kError, "t.csv:4, column hbase_m", "above h_m");
  expect_listed(reading, Severity::kError, "t.csv:5", "3 fields");
}

TEST(InventoryCheck, EveryMissingColumnHasItsOwnMessage) {
  const InventoryReading reading = examine_inventory("dbh_cm,h_m\n20,18\n", "t.csv");
  for (const char* column : {"id_tree", "species", "x", "y"})
    expect_listed(reading, Severity::kError, std::string("t.csv:1, column ") + column, "missing");
  EXPECT_TRUE(reading.trees.empty());
}

TEST(InventoryCheck, TwoColumnsOfOneMeaning) {
  const InventoryReading reading =
      examine_inventory("id,species,x,y,dbh_cm,dbh_mm\n1,beech,0,0,20,200\n", "t.csv");
  expect_listed(reading, Severity::kError, "column dbh_mm", "says the same as column dbh_cm");
}

std::string rows_with(const std::string& header, const std::string& values) {
  std::string csv = "id_tree,species,x,y," + header + "\n";
  for (int i = 1; i <= 8; ++i)
    csv += std::to_string(i) + ",beech," + std::to_string(3 * i) + ",0," + values + "\n";
  return csv;
}

TEST(InventoryCheck, UnitsOffByAHundredAreOneProblemPerColumn) {
  struct Case {
    const char *header, *values, *column, *looks;
  };
  for (const Case& c : {Case{"dbh_cm,h_m", "0.32,21", "dbh_cm", "metres"},
                        Case{"dbh_cm,h_m", "320,21", "dbh_cm", "millimetres"},
                        Case{"dbh_cm,h_m", "32,2100", "h_m", "centimetres"},
                        Case{"dbh_cm,h_m,rn_m", "32,21,310", "rn_m", "centimetres"},
                        Case{"dbh_m,h_m", "32,21", "dbh_m", "centimetres"}}) {
    const InventoryReading reading = examine_inventory(rows_with(c.header, c.values), "t.csv");
    expect_listed(reading, Severity::kError, std::string("t.csv:1, column ") + c.column, c.looks);
    EXPECT_EQ(reading.problems.size(), 1u) << listed(reading);
  }
  EXPECT_FALSE(examine_inventory(rows_with("dbh_cm,h_m", "32,21"), "t.csv").has_errors());
}

TEST(InventoryCheck, BareNamesAreInferredWithAWarning) {
  const InventoryReading metres = examine_inventory(rows_with("dbh,height_m", "0.32,21"), "t.csv");
  EXPECT_FALSE(metres.has_errors()) << listed(metres);
  EXPECT_NEAR(metres.trees[0].dbh_cm, 32, 1e-9);
  expect_listed(metres, Severity::kWarning, "column dbh", "taken as metres");
  EXPECT_NEAR(examine_inventory(rows_with("dbh,height_m", "320,21"), "t.csv").trees[0].dbh_cm, 32, 1e-9);
  EXPECT_NEAR(examine_inventory(rows_with("dbh_mm,height_cm", "320,2100"), "t.csv").trees[0].height_m.value(),
              21, 1e-9);
}

TEST(InventoryCheck, ReadsTheTreeListOfILand) {
  const InventoryReading reading =
      examine_inventory("x;y;species;dbh;height;age\n1.5;2;piab;30;24;80\n4;2;fasy;22;19.5;70\n", "i.csv");
  EXPECT_FALSE(reading.has_errors()) << listed(reading);
  ASSERT_EQ(reading.trees.size(), 2u);
  EXPECT_EQ(reading.trees[1].id.value, 2u);
  EXPECT_EQ(reading.trees[1].species, "fasy");
  EXPECT_NEAR(reading.trees[0].dbh_cm, 30, 1e-9);
  EXPECT_NEAR(*reading.trees[0].height_m, 24, 1e-9);
}

// One degree of latitude at 50 degrees north is 111.229 km, one of longitude 71.696 km (WGS84).
TEST(InventoryCheck, DegreesBecomeMetresAroundTheMean) {
  const InventoryReading reading = examine_inventory(
      "id,species,lon,lat,dbh_cm\n1,beech,5.000,49.9995,20\n2,beech,5.001,50.0005,20\n", "t.csv");
  ASSERT_EQ(reading.trees.size(), 2u) << listed(reading);
  EXPECT_NEAR(reading.trees[1].x_m - reading.trees[0].x_m, 71.696, 2e-3);
  EXPECT_NEAR(reading.trees[1].y_m - reading.trees[0].y_m, 111.229, 2e-3);
  expect_listed(reading, Severity::kWarning, "t.csv", "5.000500 degrees east");
  expect_listed(examine_inventory("id,species,lon,dbh_cm\n1,beech,5,20\n", "t.csv"), Severity::kError,
                "column lat", "missing");
}

TEST(InventoryCheck, TreesAtOnePoint) {
  const std::string head = "id_tree,species,x,y,dbh_cm\n";
  const InventoryReading coppice =
      examine_inventory(head + "1,beech,1,1,20\n2,beech,1,1,22\n3,beech,4,1,20\n", "t.csv");
  EXPECT_FALSE(coppice.has_errors());
  expect_listed(coppice, Severity::kWarning, "t.csv:3", "very place of tree 1");
  const InventoryReading heap =
      examine_inventory(head + "1,beech,1,1,20\n2,beech,1,1,22\n3,beech,1,1,20\n", "t.csv");
  expect_listed(heap, Severity::kError, "t.csv", "all trees stand at one point");
}

TEST(InventoryCheck, SpeciesAndAllometry) {
  const auto library = SpeciesLibrary::load(test::source_dir() / "configs/species");
  const auto path = test::scratch_dir() / "check.csv";
  std::ofstream(path) << "id_tree,species,x,y,dbh_cm,h_m,rn_m\n1,beech,0,0,40,4,3\n2,unicorn,3,0,30,22,3\n"
                         "3,unicorn,6,0,30,22,3\n4,beech,9,0,30,22,20\n5,beech,12,0,30,22,3\n";
  const InventoryReading reading = check_inventory(path, library);
  expect_listed(reading, Severity::kWarning, ":2", "a height of 4 m");
  expect_listed(reading, Severity::kError, ":3, column species", "unicorn");
  expect_listed(reading, Severity::kWarning, ":5", "crown radius");
  EXPECT_EQ(reading.problems.size(), 3u) << listed(reading);  // the second unicorn is not told again
}

TEST(InventoryCheck, UnknownColumnsAreNamed) {
  const InventoryReading reading =
      examine_inventory("id,species,x,y,dbh_cm,colour\n1,beech,0,0,20,red\n", "t.csv");
  expect_listed(reading, Severity::kWarning, "column colour", "not used");
  EXPECT_EQ(reading.trees.size(), 1u);
}

}  // namespace
}  // namespace sunfleck
