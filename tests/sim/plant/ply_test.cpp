// PLY meshes, ascii and binary: the same tree from both, properties passed over, damaged files refused.
#include <cstring>

#include "sim/plant/make_prototype.h"
#include "tests/sim/plant/refusal.h"

namespace sunfleck {
namespace {

const MeshMaterials kLeaves{{{"", "leaf"}}, {}};

template <class T>
void put(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

const std::string kHead =
    "element vertex 4\nproperty float x\nproperty uchar red\nproperty double y\nproperty float z\n"
    "element edge 1\nproperty list uchar short ends\n"
    "element face 2\nproperty int label\nproperty list uchar uint vertex_indices\nend_header\n";

std::string ascii() {
  return "ply\nformat ascii 1.0\ncomment a quad 2 x 1 and half of it\n" + kHead +
         "0 9 0 1\n2 9 0 1\n2 9 1 1\n0 9 1 1\n2 0 1\n5 4 0 1 2 3\n5 3 0 1 2\n";
}

std::string binary() {
  std::string out = "ply\nformat binary_little_endian 1.0\n" + kHead;
  const float corners[4][2] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  for (const auto& corner : corners) {
    put(out, corner[0]);
    put(out, std::uint8_t{10});  // a byte that looks like a line end
    put(out, double{corner[1]});
    put(out, 1.0f);
  }
  put(out, std::uint8_t{2});
  for (const std::int16_t end : {0, 1}) put(out, end);
  for (const std::uint8_t count : {4, 3}) {
    put(out, std::int32_t{5});
    put(out, count);
    for (std::uint32_t i = 0; i < count; ++i) put(out, i);
  }
  return out;
}

Prototype import_content(const std::string& content, ImportReport* report = nullptr) {
  return import_mesh(test::write_scratch("tree.ply", content), kLeaves, report);
}

TEST(Ply, AsciiAndBinaryGiveTheSameLeaves) {
  for (const std::string& content : {ascii(), binary()}) {
    ImportReport report;
    const Prototype p = import_content(content, &report);
    EXPECT_EQ(report.parallelograms, 1u);
    EXPECT_EQ(report.triangles, 1u);
    EXPECT_NEAR(leaf_area_m2(p), 3, 1e-6);
    EXPECT_NEAR(glm::distance(Vec3(p.foliage[0].centre_m), Vec3(1, 0.5, 1)), 0, 1e-6);
  }
}

TEST(Ply, WoodByTheEmptyName) {
  const auto path = test::write_scratch("wood.ply", ascii());
  EXPECT_EQ(import_mesh(path, {{}, {{"", "bark"}}}).wood_mesh.size(), 3u);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Ply, MistakesAreRefused) {
  struct Case {
    std::string content;
    const char *where, *problem, *remedy;
  };
  const Case cases[] = {
      {"", "tree.ply:1", "no PLY", "ply"},
      {"solid\n", "tree.ply:1", "no PLY", "ply"},
      {"ply\nformat ascii 1.0\n", "tree.ply", "no end", "end_header"},
      {"ply\nend_header\n", "tree.ply", "no leaf", "at least one"},
      {replaced(ascii(), "ascii 1.0", "binary_big_endian 1.0"), "tree.ply:2", "not read", "little_endian"},
      {replaced(ascii(), "float x", "half x"), "tree.ply:5", "unknown type \"half\"", "float"},
      {replaced(ascii(), "vertex 4", "vertex -4"), "tree.ply:4", "negative", "how many"},
      {replaced(ascii(), "vertex 4", "vertex 4000000000"), "tree.ply", "more than the file can hold",
       "truncated"},
      {replaced(ascii(), "comment", "remark"), "tree.ply:3", "unknown word \"remark\"", "comment"},
      {replaced(ascii(), "element vertex 4\n", ""), "tree.ply:4", "before any element", "element"},
      {replaced(ascii(), "2 9 1 1", "2 9 b 1"), "tree.ply:17", "\"b\" is not a finite number", "number"},
      {replaced(ascii(), "2 9 1 1", "2 9 nan 1"), "tree.ply:17", "not a finite number", "number"},
      {replaced(ascii(), "3 0 1 2\n", "3 0 1 7\n"), "tree.ply:21", "corner 7 is no vertex", "4 vertices"},
      {replaced(ascii(), "3 0 1 2\n", "3 0 1 -1\n"), "tree.ply:21", "no vertex number", "from 0"},
      {replaced(ascii(), "3 0 1 2\n", "2 0 1\n"), "tree.ply:21", "fewer than three", "three"},
      {replaced(ascii(), "3 0 1 2\n", "3 0 1"), "tree.ply:21", "ends before", "truncated"},
      {replaced(ascii(), "property float z", "property float w"), "tree.ply:15", "no finite x, y and z",
       "metres"},
      {binary().substr(0, binary().size() - 3), "byte", "ends before", "truncated"},
  };
  for (const Case& each : cases)
    test::expect_refused([&] { import_content(each.content); }, ErrorKind::kInvalidInput, each.where,
                         each.problem, each.remedy);
}

// Every cut of a binary file is refused, none crashes.
TEST(Ply, EveryTruncationIsRefused) {
  const std::string whole = binary();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(import_content(whole.substr(0, size)), Error) << size;
}

}  // namespace
}  // namespace sunfleck
