// Leaf lists: what is read, what is refused, and the published RAMI crown.
#include <zlib.h>

#include <cmath>

#include "sim/plant/make_prototype.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

Prototype import_text(std::string_view text, ImportReport* report = nullptr) {
  return import_leaf_list(test::write_scratch("leaves.txt", text), "leaf", report);
}

TEST(LeafList, DiscsAndQuadsAreRead) {
  ImportReport report;
  const Prototype p = import_text(
      "# head\n"
      "0.5 1 2 3 0 0 2\r\n"  // disc, normal of any length
      "\n"
      "\t0 0 1  2 0 1  3 1 1  1 1 1  # parallelogram of area 2\n"
      "0 0 1  4 0 1  3 1 1  1 1 1\n"     // trapezium of area (4 + 2) / 2: two triangles
      "0 0 1  2 0 1  2.001 1 1  0 1 1",  // a rectangle but for 0.5e-3: still one parallelogram
      &report);
  ASSERT_EQ(p.foliage.size(), 5u);
  EXPECT_EQ(report.discs, 1u);
  EXPECT_EQ(report.parallelograms, 2u);
  EXPECT_EQ(report.triangles, 2u);
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_EQ(p.materials, std::vector<std::string>{"leaf"});
  EXPECT_EQ(p.foliage[0].shape, ElementShape::kDisc);
  EXPECT_EQ(p.foliage[0].centre_m, Vec3f(1, 2, 3));
  EXPECT_NEAR(p.foliage[0].area_m2, kPi / 4, 1e-6);
  EXPECT_NEAR(glm::distance(element_normal(p.foliage[0]), Vec3(0, 0, 1)), 0, 1e-6);
  EXPECT_NEAR(p.foliage[1].area_m2, 2, 1e-6);
  EXPECT_NEAR(p.foliage[2].area_m2 + p.foliage[3].area_m2, 3, 1e-6);
  EXPECT_NEAR(p.foliage[4].area_m2, 2.0005, 1e-6);
  for (const FoliageElement& e : p.foliage) EXPECT_NEAR(element_normal(e).z, 1, 1e-6);
}

TEST(LeafList, LeavesWithoutAreaAndBelowTheGroundAreReported) {
  ImportReport report;
  const Prototype p = import_text("0 1 2 3 0 0 1\n1 0 0 -3 1 0 0\n0 0 0 1 0 0 2 0 0 3 0 0\n", &report);
  EXPECT_EQ(p.foliage.size(), 1u);
  EXPECT_EQ(report.degenerate_skipped, 3u);  // the disc and both triangles of the quad
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_NE(report.warnings[0].find("skipped 3 faces"), std::string::npos);
  EXPECT_NE(report.warnings[1].find("4.0"), std::string::npos) << report.warnings[1];  // -3 - radius
}

TEST(LeafList, MistakesAreRefusedWithFileAndLine) {
  struct Case {
    const char *text, *where, *problem, *remedy;
  };
  const Case cases[] = {
      {"", "leaves.txt", "no leaf", "at least one"},
      {"# only a comment\n", "leaves.txt", "no leaf", "at least one"},
      {"0 1 2 3 0 0 1\n", "leaves.txt", "no leaf", "at least one"},
      {"1 0 0 1 0 0 1\n1 2 3\n", "leaves.txt:2", "has 3 numbers", "7"},
      {"1 0 0 1 0 0 1 8\n", "leaves.txt:1", "has 8 numbers", "12"},
      {"1 0 0 x 0 0 1\n", "leaves.txt:1", "\"x\"", "number"},
      {"1 0 0 1,5 0 0 1\n", "leaves.txt:1", "\"1,5\"", "number"},
      {"1 0 0 nan 0 0 1\n", "leaves.txt:1", "\"nan\"", "number"},
      {"1 0 0 1e999 0 0 1\n", "leaves.txt:1", "\"1e999\"", "number"},
      {"1 inf 0 1 0 0 1\n", "leaves.txt:1", "\"inf\"", "number"},
      {"-1 0 0 1 0 0 1\n", "leaves.txt:1", "radius", "above 0"},
      {"1 0 0 1 0 0 0\n", "leaves.txt:1", "normal", "direction"},
      {"1 512345 0 1 0 0 1\n", "leaves.txt:1", "10 km", "origin"},
      {"0 0 1e9 1 0 0 2 0 0 3 0 0\n", "leaves.txt:1", "10 km", "origin"},
  };
  for (const Case& each : cases)
    test::expect_refused([&] { import_text(each.text); }, ErrorKind::kInvalidInput, each.where, each.problem,
                         each.remedy);
  test::expect_refused([] { import_leaf_list("absent.txt", "leaf"); }, ErrorKind::kNotFound, "absent.txt",
                       "no such", "path");
  test::expect_refused([] { import_leaf_list(test::scratch_dir(), "leaf"); }, ErrorKind::kNotFound, "",
                       "is a folder", "path");
  test::expect_refused([] { import_leaf_list("absent.txt", ""); }, ErrorKind::kInvalidInput, "material",
                       "empty", "species");
}

TEST(LeafList, GzipIsReadAndATruncatedOneRefused) {
  const auto path = test::scratch_dir() / "leaves.txt.gz";
  gzFile file = gzopen(path.c_str(), "wb");
  for (int i = 0; i < 2000; ++i) gzprintf(file, "0.1 %d 0 %d 0 %d 1\n", i % 7, i, i % 5);
  gzclose(file);
  EXPECT_EQ(import_leaf_list(path, "leaf").foliage.size(), 2000u);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  test::expect_refused([&] { import_leaf_list(path, "leaf"); }, ErrorKind::kInputOutput, "leaves.txt.gz",
                       "cannot be read", "truncated");
}

// The crown of scene HET01 of RAMI: 49,999 discs of radius 0.1 m, so pi * 0.01 * 49,999 m2.
TEST(LeafList, RamiCrown) {
  const auto path = test::shared_data("rami-het01/crown_discs.txt.gz");
  if (!path) GTEST_SKIP() << "RAMI crown is absent";
  ImportReport report;
  const Prototype p = import_leaf_list(*path, "leaf", &report);
  EXPECT_EQ(report.discs, 49999u);
  EXPECT_NEAR(leaf_area_m2(p), kPi * 0.01 * 49999, 1e-2);  // 1570.76
}

}  // namespace
}  // namespace sunfleck
