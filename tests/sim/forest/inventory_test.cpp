// Inventories as people write them: all accepted spellings of a CSV, the measured stands, and a table of rows
// that must be refused at the right line and column.

#include <gtest/gtest.h>

#include <fstream>

#include "sim/forest/forest_spec.h"
#include "tests/sim/forest/expect_refusal.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

const std::string kHeader =
    "id_tree,species,x,y,dbh_cm,crown_type,h_m,hbase_m,hmax_m,rn_m,rs_m,re_m,rw_m,crown_lad\n";

TEST(Inventory, FullRow) {
  const auto trees = parse_inventory(
      kHeader + "209,Quercus sp.,57.4,-62.99,72.57,8E,27.9,4.1,14.12,5.34,3.08,4.94,6.71,0.5\n", "t");
  ASSERT_EQ(trees.size(), 1U);
  const InventoryTree& tree = trees[0];
  EXPECT_EQ(tree.id.value, 209U);
  EXPECT_EQ(tree.species, "Quercus sp.");
  EXPECT_EQ(tree.x_m, 57.4);
  EXPECT_EQ(tree.y_m, -62.99);
  EXPECT_EQ(tree.dbh_cm, 72.57);
  EXPECT_EQ(tree.height_m, 27.9);
  EXPECT_EQ(tree.crown_base_m, 4.1);
  EXPECT_EQ(tree.widest_m, 14.12);
  EXPECT_EQ(tree.radius_n_m, 5.34);
  EXPECT_EQ(tree.radius_s_m, 3.08);
  EXPECT_EQ(tree.radius_e_m, 4.94);
  EXPECT_EQ(tree.radius_w_m, 6.71);
  EXPECT_EQ(tree.leaf_area_density_per_m, 0.5);
}

TEST(Inventory, OnlyNeededColumnsInAnyOrder) {
  const auto trees = parse_inventory("dbh_cm,note,y,x,species,id_tree\n20,old,2,1,beech,7\n", "t");
  ASSERT_EQ(trees.size(), 1U);
  EXPECT_EQ(trees[0].id.value, 7U);
  EXPECT_EQ(trees[0].x_m, 1.0);
  EXPECT_EQ(trees[0].y_m, 2.0);
  EXPECT_FALSE(trees[0].height_m);
}

// The same two trees, written as different programs write them.
TEST(Inventory, EverySpellingOfACsv) {
  const std::vector<std::string> spellings{
      "id_tree,species,x,y,dbh_cm,h_m\n1,beech,0,1,20,NA\n2,\"oak, red\",3,4,30.5,12\n",
      "id_tree,species,x,y,dbh_cm,h_m\r\n1,beech,0,1,20,\r\n2,\"oak, red\",3,4,30.5,12",
      "\xEF\xBB\xBFid_tree;species;x;y;dbh_cm;h_m\n1;beech;0;1;20;NA\n\n2;oak, red;3;4;30.5;12\n\n",
      "# two trees\nID_TREE; Species ;X;Y;DBH_cm;H_m\r1 ; beech ; 0 ; 1 ; 20 ; \r2;\"oak, red\" "
      ";3;4;3.05e1;12\r",
      "id_tree\tspecies\tx\ty\tdbh_cm\th_m\n1\tbeech\t0\t1\t20\t\n2\toak, red\t3\t4\t30.5\t12\n",
      "\"id_tree\",\"species\",\"x\",\"y\",\"dbh_cm\",\"h_m\"\n\"1\",\"beech\",\"0\",\"1\",\"20\",\"NA\"\n"
      "\"2\",\"oak, red\",\"3\",\"4\",\"30.5\",\"12\"\n"};
  for (const std::string& csv : spellings) {
    const auto trees = parse_inventory(csv, "t");
    ASSERT_EQ(trees.size(), 2U) << csv;
    EXPECT_EQ(trees[0].species, "beech") << csv;
    EXPECT_FALSE(trees[0].height_m) << csv;
    EXPECT_EQ(trees[1].species, "oak, red") << csv;
    EXPECT_EQ(trees[1].dbh_cm, 30.5) << csv;
    EXPECT_EQ(trees[1].height_m, 12.0) << csv;
  }
}

TEST(Inventory, RowsRememberTheirLine) {
  const auto trees = parse_inventory("# a comment\nid_tree,species,x,y,dbh_cm\n\n7,beech,0,0,9\n", "t.csv");
  EXPECT_EQ(trees[0].where, "t.csv:4");
}

TEST(Inventory, DoubledQuoteIsAQuote) {
  EXPECT_EQ(parse_inventory("id_tree,species,x,y,dbh_cm\n1,\"the \"\"old\"\" oak\",0,0,9\n", "t")[0].species,
            "the \"old\" oak");
}

struct BadTable {
  std::string csv, where, problem;
};

// Rows are given below the header of needed columns, at line 2; line 3 where one good row comes first.
BadTable bad_row(const std::string& row, const std::string& where, const std::string& problem) {
  return {"id_tree,species,x,y,dbh_cm\n" + row + "\n", where, problem};
}
BadTable bad_measures(const std::string& measures, const std::string& where, const std::string& problem) {
  return {kHeader + "1,beech,0,0,20," + measures + "\n", where, problem};
}

TEST(Inventory, BadTablesAreRefusedWhereTheyAreBad) {
  const std::string good = "1,beech,0,0,20\n";
  const std::vector<BadTable> bad{
      {"", "t.csv", "empty"},
      {"\n\n# nothing\n", "t.csv", "empty"},
      {"id_tree,species,x,y,dbh_cm\n", "t.csv", "no trees"},
      {"id_tree,species,x,y\n1,beech,0,0\n", "t.csv:1, column dbh_cm", "missing"},
      {"id_tree,species,x,y,dbh_cm,X\n", "t.csv:1", "two columns x"},
      bad_row("1,beech,0,0", "t.csv:2", "4 fields"),
      bad_row("1,beech,0,0,20,9", "t.csv:2", "6 fields"),
      bad_row(good + "2,\"beech,0,0,20", "t.csv:3", "quote"),
      bad_row("one,beech,0,0,20", "t.csv:2, column id_tree", "not a number"),
      bad_row("1.5,beech,0,0,20", "t.csv:2, column id_tree", "no whole number"),
      bad_row("-1,beech,0,0,20", "t.csv:2, column id_tree", "out of range"),
      bad_row("4294967296,beech,0,0,20", "t.csv:2, column id_tree", "out of range"),
      bad_row(good + "\n1,beech,5,5,20", "t.csv:4, column id_tree", "was there before, at t.csv:2"),
      bad_row("1,,0,0,20", "t.csv:2, column species", "missing"),
      bad_row("1,beech,,0,20", "t.csv:2, column x", "not a number"),
      bad_row("1,beech,0,nan,20", "t.csv:2, column y", "not a number"),
      bad_row("1,beech,inf,0,20", "t.csv:2, column x", "not a number"),
      bad_row("1,beech,1e99,0,20", "t.csv:2, column x", "out of range"),
      bad_row("1,beech,0,0,-20", "t.csv:2, column dbh_cm", "out of range"),
      bad_row("1,beech,0,0,0", "t.csv:2, column dbh_cm", "out of range"),
      bad_row("1,beech,0,0,20 cm", "t.csv:2, column dbh_cm", "not a number"),
      {"id_tree;species;x;y;dbh_cm\n1;beech;0;0;20,5\n", "t.csv:2, column dbh_cm", "not a number"},
      bad_measures("8E,-9,1,2,1,1,1,1,0.5", "t.csv:2, column h_m", "out of range"),
      bad_measures("8E,high,1,2,1,1,1,1,0.5", "t.csv:2, column h_m", "not a number"),
      bad_measures("8E,9,10,10,1,1,1,1,0.5", "t.csv:2, column hbase_m", "above h_m"),
      bad_measures("8E,9,9,NA,1,1,1,1,0.5", "t.csv:2, column hbase_m", "at the top"),
      bad_measures("8E,9,5,4,1,1,1,1,0.5", "t.csv:2, column hbase_m", "above hmax_m"),
      bad_measures("8E,9,5,9.1,1,1,1,1,0.5", "t.csv:2, column hmax_m", "above h_m"),
      bad_measures("8E,9,1,2,1,-1,1,1,0.5", "t.csv:2, column rs_m", "out of range"),
      bad_measures("8E,9,1,2,1,1,1,1,-0.5", "t.csv:2, column crown_lad", "out of range"),
      bad_measures("8E,9,1,2,1,1,1,1,NaN", "t.csv:2, column crown_lad", "not a number"),
      bad_measures("P,9,1,2,1,1,1,1,0.5", "t.csv:2, column crown_type", "not supported"),
  };
  for (const BadTable& table : bad) {
    SCOPED_TRACE(table.csv);
    test::expect_refusal([&] { parse_inventory(table.csv, "t.csv"); }, ErrorKind::kInvalidInput, table.where,
                         table.problem);
  }
}

TEST(Inventory, FilesThatAreNone) {
  const auto folder = test::scratch_dir();
  test::expect_refusal([&] { read_inventory(folder / "absent.csv"); }, ErrorKind::kNotFound, "absent.csv",
                       "no such");
  test::expect_refusal([&] { read_inventory(folder); }, ErrorKind::kInvalidInput, folder.string(),
                       "is a folder, not a file");
}

// Number of trees and the sums that any other program gives for the columns (awk over the files).
TEST(Inventory, MeasuredStands) {
  const auto cloture = test::shared_data("stands/cloture20/trees.csv");
  const auto bechefa = test::shared_data("stands/bechefa/trees.csv");
  if (!cloture || !bechefa) GTEST_SKIP() << "measured stands are absent";
  EXPECT_EQ(read_inventory(*cloture).size(), 112U);
  const auto trees = read_inventory(*bechefa);
  EXPECT_EQ(trees.size(), 201U);
  double tallest_m = 0;
  for (const InventoryTree& tree : trees) {
    ASSERT_TRUE(tree.height_m && tree.crown_base_m && tree.widest_m && tree.radius_n_m && tree.radius_s_m &&
                tree.radius_e_m && tree.radius_w_m && tree.leaf_area_density_per_m);
    EXPECT_EQ(*tree.leaf_area_density_per_m, 0.6);
    tallest_m = std::max(tallest_m, *tree.height_m);
  }
  EXPECT_NEAR(tallest_m, 54, 1);  // "trees up to 54 m"
}

}  // namespace
}  // namespace sunfleck
