// Cylinder tables of the usual programs become the same wood; what is wrong in one is said with its line.
#include <cmath>

#include "sim/exchange/qsm.h"
#include "sim/plant/text_file.h"
#include "tests/sim/plant/crown_fixture.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

using test::expect_refused;
using test::write_scratch;

Prototype read(const std::string& csv, QsmReport* report = nullptr) {
  return import_qsm(write_scratch("tree.csv", csv), "Fagus sylvatica", report);
}

// One trunk of 2 m and a branch of 1 m, written four ways.
const char* const kWays[] = {
    "id,parent_id,start_x_m,start_y_m,start_z_m,end_x_m,end_y_m,end_z_m,radius_m\n"
    "1,0,0,0,0,0,0,2,0.1\n2,1,0,0,2,1,0,2,0.05\n",
    "ID;parentID;startX;startY;startZ;endX;endY;endZ;radius\n0;-1;0;0;0;0;0;2;0.1\n1;0;0;0;2;1;0;2;0.05\n",
    "radius (m)\tlength "
    "(m)\tstart_point_1\tstart_point_2\tstart_point_3\taxis_direction_1\taxis_direction_2\t"
    "axis_direction_3\tparent\n0.1\t2\t0\t0\t0\t0\t0\t1\t0\n0.05\t1\t0\t0\t2\t1\t0\t0\t1\n",
    "startX,startY,startZ,endX,endY,endZ,cyl_ID,parent_ID,radius_cyl\n0,0,0,0,0,2,1,0,0.1\n0,0,2,1,0,2,2,1,."
    "05\n"};

TEST(Qsm, TheUsualColumnsMeanTheSame) {
  for (const char* way : kWays) {
    QsmReport report;
    const Prototype tree = read(way, &report);
    ASSERT_EQ(tree.wood.size(), 2u) << way;
    EXPECT_EQ(report.cylinders, 2u);
    EXPECT_TRUE(report.warnings.empty());
    EXPECT_EQ(tree.wood[0].to_m, Vec3f(0, 0, 2)) << way;
    EXPECT_NEAR(glm::distance(tree.wood[1].to_m, Vec3f(1, 0, 2)), 0, 1e-6) << way;
    EXPECT_FLOAT_EQ(tree.wood[1].radius_from_m, 0.05f);
    EXPECT_FLOAT_EQ(tree.wood[1].radius_to_m, 0.05f);
  }
}

TEST(Qsm, AScanInMapCoordinatesComesToTheOrigin) {
  QsmReport report;
  const Prototype tree = read(
      "start_x,start_y,start_z,end_x,end_y,end_z,radius\n"
      "452100.5,5411200.25,310,452100.5,5411200.25,312,0.1\n452100.5,5411200.25,312,452101.5,5411200.25,312,"
      "0.1\n",
      &report);
  EXPECT_EQ(tree.wood[1].to_m, Vec3f(1, 0, 2));
  EXPECT_EQ(report.moved_m, Vec3(-452100.5, -5411200.25, -310));
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("452100.500"), std::string::npos);
}

TEST(Qsm, CylindersWithoutLengthAreCountedAndLeftOut) {
  QsmReport report;
  const Prototype tree = read(
      "start_x,start_y,start_z,end_x,end_y,end_z,radius\n0,0,0,0,0,2,0.1\n0,0,2,0,0,2,0.1\n0,0,2,0,0,3,0\n",
      &report);
  EXPECT_EQ(tree.wood.size(), 1u);
  EXPECT_EQ(report.degenerate_skipped, 2u);
}

struct BadTable {
  const char *csv, *where, *problem, *remedy;
};

TEST(Qsm, WhatIsWrongIsSaidWithItsPlace) {
  const BadTable bad[] = {
      {"start_x,start_y,end_x,end_y,end_z,radius\n0,0,0,0,1,1\n", "tree.csv:1", "no column \"startz\"",
       "radius"},
      {"x,y,z,radius\n0,0,0,1\n", "tree.csv:1", "no column \"endx\"", "axis_x"},
      {"x,y,z,end_x,end_y,end_z\n0,0,0,0,0,1\n", "tree.csv:1", "no column \"radius\"", "radius"},
      {"x,y,z,end_x,end_y,end_z,radius\n0,0,0,0,0,one,1\n", "tree.csv:2, column end_z", "one", "metres"},
      {"x,y,z,end_x,end_y,end_z,radius\n0,0,0,0,0,1,-0.1\n", "tree.csv:2, column radius", "-0.1", "radius"},
      {"x,y,z,end_x,end_y,end_z,radius\n0,0,0,0,0,1,nan\n", "tree.csv:2, column radius", "nan", "radius"},
      {"x,y,z,end_x,end_y,end_z,radius\n0,0,0,0,0,1,150\n", "tree.csv:2", "150", "millimetres"},
      {"x,y,z,end_x,end_y,end_z,radius\n0,0,0,0,0,1500,1\n", "tree.csv:2", "longer than 200 m", "metres"},
      {"id,parent,x,y,z,end_x,end_y,end_z,radius\n1,0,0,0,0,0,0,1,1\n2,7,0,0,1,0,0,2,1\n", "tree.csv:3",
       "parent 7", "another row"},
      {"id,parent,x,y,z,end_x,end_y,end_z,radius\n1,0,0,0,0,0,0,1,1\n1,0,0,0,1,0,0,2,1\n", "tree.csv:3",
       "twice", "one tree"},
      {"x,y,z,end_x,end_y,end_z,radius\n", "tree.csv", "no cylinder", "start_x"}};
  for (const BadTable& b : bad)
    expect_refused([&] { read(b.csv); }, ErrorKind::kInvalidInput, b.where, b.problem, b.remedy);
  expect_refused([] { import_qsm(test::scratch_dir() / "absent.csv", "x"); }, ErrorKind::kNotFound,
                 "absent.csv", "", "");
}

TEST(Qsm, RoundTripKeepsWoodAndFindsParents) {
  Prototype tree;
  tree.materials = {"Fagus sylvatica"};
  tree.wood = {{{0, 0, 0}, {0, 0, 2}, 0.1f, 0.08f, 0},
               {{0, 0, 2}, {0, 0, 3}, 0.08f, 0.06f, 0},      // goes on
               {{0, 0, 2}, {1, 0, 2.5}, 0.03f, 0.01f, 0},    // branch
               {{1, 0, 2.5}, {2, 0, 2.5}, 0.01f, 0.01f, 0},  // of the branch
               {{1, 0, 2.5}, {1, 1, 2.5}, 0.005f, 0.005f, 0}};
  EXPECT_EQ(wood_parents(tree.wood), (std::vector<int>{-1, 0, 0, 2, 2}));
  const auto path = test::scratch_dir() / "out.csv";
  EXPECT_EQ(export_qsm(tree, path), 0u);
  const Prototype back = import_qsm(path, "Fagus sylvatica");
  ASSERT_EQ(back.wood.size(), tree.wood.size());
  for (std::size_t i = 0; i < tree.wood.size(); ++i) {
    EXPECT_EQ(back.wood[i].from_m, tree.wood[i].from_m);
    EXPECT_EQ(back.wood[i].to_m, tree.wood[i].to_m);
    EXPECT_EQ(back.wood[i].radius_from_m, tree.wood[i].radius_from_m);
    EXPECT_EQ(back.wood[i].radius_to_m, tree.wood[i].radius_to_m);
  }
  const std::string text = read_text_file(path);
  EXPECT_NE(text.find("\n2,1,0,"), std::string::npos) << text;  // the stem goes on with order 0
  EXPECT_NE(text.find("\n3,1,1,"), std::string::npos);
  EXPECT_NE(text.find("\n4,3,1,"), std::string::npos);
  EXPECT_NE(text.find("\n5,3,2,"), std::string::npos);
}

TEST(Qsm, APrototypeWithoutWoodIsRefused) {
  Prototype leaves;
  leaves.materials = {"x"};
  expect_refused([&] { export_qsm(leaves, test::scratch_dir() / "none.csv"); }, ErrorKind::kInvalidInput,
                 "none.csv", "no wood", "obj");
}

}  // namespace
}  // namespace sunfleck
