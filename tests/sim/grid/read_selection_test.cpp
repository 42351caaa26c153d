// A part of a forest file: the same bits as in the whole, and nothing of the rest.
#include "sim/grid/read_selection.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "sim/base/error.h"
#include "sim/grid/forest_file.h"
#include "sim/grid/forest_tables.h"
#include "sim/grid/sealed_file.h"
#include "sim/grid/vdb_archive.h"
#include "tests/sim/grid/sample_forests.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

namespace fs = std::filesystem;

fs::path saved(const Forest& forest, const std::string& file) {
  const fs::path path = test::scratch_dir() / file;
  save_forest(forest, path);
  return path;
}

TEST(ReadSelection, SketchTellsWhatTreesFill) {
  const Forest forest = test::varied_forest();
  const auto sketch = read_sketch(saved(forest, "sketch.vdb"));
  ASSERT_TRUE(sketch.has_value());
  EXPECT_EQ(sketch->content_hash(), content_hash(forest));
  const std::vector<Box> boxes = instance_boxes(sketch->outline);
  ASSERT_EQ(boxes.size(), forest.instances.size());
  Box all;
  for (const Box& box : boxes) all.include(box);
  EXPECT_EQ(all.lo, forest_bounds(forest).lo);  // the same bits
  EXPECT_EQ(all.hi, forest_bounds(forest).hi);
  for (std::size_t p = 0; p < forest.prototypes.size(); ++p)
    EXPECT_EQ(sketch->outline.prototypes[p].foliage_elements, forest.prototypes[p].foliage.size());
}

TEST(ReadSelection, AllOfItIsTheForest) {
  const Forest forest = test::varied_forest();
  const auto sketch = read_sketch(saved(forest, "all.vdb"));
  const Forest read = load_prototypes(*sketch, std::vector<char>(forest.prototypes.size(), 1));
  EXPECT_EQ(content_hash(read), content_hash(forest));
}

TEST(ReadSelection, EachPrototypeAloneHasTheSameBits) {
  const Forest forest = test::varied_forest();
  const auto sketch = read_sketch(saved(forest, "alone.vdb"));
  for (std::size_t wanted = 0; wanted < forest.prototypes.size(); ++wanted) {
    std::vector<char> only(forest.prototypes.size(), 0);
    only[wanted] = 1;
    const Forest part = load_prototypes(*sketch, only);
    EXPECT_EQ(part.instances.size(), forest.instances.size());
    for (std::size_t p = 0; p < forest.prototypes.size(); ++p) {
      EXPECT_EQ(part.prototypes[p].name, forest.prototypes[p].name);
      EXPECT_EQ(part.prototypes[p].materials, forest.prototypes[p].materials);
      if (p == wanted)
        EXPECT_EQ(content_hash(part.prototypes[p]), content_hash(forest.prototypes[p]));
      else
        EXPECT_TRUE(part.prototypes[p].foliage.empty() && part.prototypes[p].wood.empty() &&
                    part.prototypes[p].wood_mesh.empty());
    }
  }
}

TEST(ReadSelection, EmptyAndLeaflessForestsHaveSketches) {
  for (const Forest& forest : {test::empty_forest(), test::leafless_forest()}) {
    const auto sketch = read_sketch(saved(forest, "bare.vdb"));
    ASSERT_TRUE(sketch.has_value());
    EXPECT_EQ(sketch->outline.prototypes.size(), forest.prototypes.size());
    const std::vector<char> all(forest.prototypes.size(), 1);
    EXPECT_EQ(content_hash(load_prototypes(*sketch, all)), content_hash(forest));
  }
}

std::string without(std::string text, const std::string& key) {
  const std::string quoted = "\"" + key + "\"";
  for (std::size_t at = text.find(quoted); at != std::string::npos; at = text.find(quoted))
    text.replace(at, quoted.size(), "\"" + std::string(key.size(), 'x') + "\"");
  return text;
}

fs::path written(const Forest& forest, const std::string& description, const std::string& file) {
  const fs::path path = test::scratch_dir() / file;
  const VdbContent content{description, {}, tables_of(forest)};
  write_sealed(path, [&](std::ostream& out) { write_vdb(content, out); });
  return path;
}

// As files were before they stated what their prototypes fill.
TEST(ReadSelection, OldFilesHaveNoSketchAndAreReadWhole) {
  const Forest forest = test::varied_forest();
  const fs::path path = written(forest, without(text_of_description(forest), "outline"), "old.vdb");
  EXPECT_FALSE(read_sketch(path).has_value());
  EXPECT_EQ(content_hash(load_forest(path)), content_hash(forest));
}

TEST(ReadSelection, WhatDoesNotMatchItsHashIsRefused) {
  const Forest forest = test::varied_forest();
  Forest other = forest;
  other.prototypes[0].foliage[0].area_m2 = 0.0f;
  other.prototypes[0].foliage[0].half_u_m = Vec3f(0.0f);
  const fs::path path = written(other, text_of_description(forest), "swapped.vdb");
  const auto sketch = read_sketch(path);
  ASSERT_TRUE(sketch.has_value());
  std::vector<char> wanted(forest.prototypes.size(), 0);
  EXPECT_NO_THROW(load_prototypes(*sketch, wanted));  // nobody looked at it
  wanted[0] = 1;
  EXPECT_THROW(load_prototypes(*sketch, wanted), Error);
  other = forest;
  other.instances[0].position_m.x += 1;
  EXPECT_THROW(read_sketch(written(other, text_of_description(forest), "moved.vdb")), Error);
}

TEST(ReadSelection, TruncatedAndMissingFilesAreRefused) {
  const fs::path path = saved(test::varied_forest(), "cut.vdb");
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_THROW(read_sketch(path), Error);
  EXPECT_THROW(read_sketch("nowhere.vdb"), Error);
}

}  // namespace
}  // namespace sunfleck
