// ConfigTable: values come back as written, and every kind of mistake is refused with a message that says
// where, what, and what would be right.
#include "sim/config/config_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "sim/base/error.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

constexpr std::string_view kGood = R"(name = "stand"
count = 3
ratio = 0.25
dense = true
sizes = [1, 2.5]
words = ["a", "b"]
[sun]
elevation_deg = 30
kind = "disc"
[[tree]]
height_m = 12
[[tree]]
height_m = 14
)";

TEST(ConfigTable, ValuesComeBackAsWritten) {
  const ConfigTable table = ConfigTable::from_text(kGood, "good.toml");
  EXPECT_EQ(table.text("name"), "stand");
  EXPECT_EQ(table.integer("count"), 3);
  EXPECT_EQ(table.number("count"), 3.0);
  EXPECT_EQ(table.number("ratio", {0, 1}), 0.25);
  EXPECT_TRUE(table.boolean("dense"));
  EXPECT_EQ(table.numbers("sizes"), (std::vector<double>{1, 2.5}));
  EXPECT_EQ(table.texts("words"), (std::vector<std::string>{"a", "b"}));
  const ConfigTable sun = table.table("sun");
  EXPECT_EQ(sun.number("elevation_deg"), 30);
  EXPECT_EQ(sun.choice("kind", {"point", "disc"}), "disc");
  const std::vector<ConfigTable> trees = table.tables("tree");
  ASSERT_EQ(trees.size(), 2u);
  EXPECT_EQ(trees[0].number("height_m") + trees[1].number("height_m"), 26);
  EXPECT_NO_THROW(table.reject_unread());
  EXPECT_EQ(sun.where("kind"), "good.toml:9: sun.kind");
  EXPECT_TRUE(table.directory().empty());
}

TEST(ConfigTable, DefaultsStandInForAbsentKeysOnly) {
  const ConfigTable table = ConfigTable::from_text("given = 2\n[sub]\n", "t");
  EXPECT_EQ(table.number_or("given", 7), 2);
  EXPECT_EQ(table.number_or("absent", 7), 7);
  EXPECT_EQ(table.integer_or("absent", 8), 8);
  EXPECT_EQ(table.text_or("absent", "x"), "x");
  EXPECT_TRUE(table.boolean_or("absent", true));
  EXPECT_EQ(table.choice_or("absent", "b", {"a", "b"}), "b");
  EXPECT_FALSE(table.table_if("absent").has_value());
  EXPECT_TRUE(table.table_if("sub").has_value());
  EXPECT_TRUE(table.tables("absent").empty());
  EXPECT_TRUE(table.has("given"));
  EXPECT_FALSE(table.has("absent"));
  EXPECT_NO_THROW(table.reject_unread());
}

struct Mistake {
  const char* what;
  std::string_view text;
  std::function<void(const ConfigTable&)> read;
  const char* where;    // all of Error::where
  const char* problem;  // part of Error::problem
  const char* remedy;   // part of Error::remedy
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.what; }

void read_ratio(const ConfigTable& t) { t.number("ratio", {0, 1}); }

void read_all_known(const ConfigTable& t) {
  t.number_or("height_m", 1);
  t.text_or("species", "");
  if (const auto sun = t.table_if("sun")) sun->number_or("elevation_deg", 45);
  for (const ConfigTable& tree : t.tables("tree")) tree.number_or("height_m", 2);
  t.reject_unread();
}

const Mistake kMistakes[] = {
    {"syntax error", "a = 1\nb = = 2\n", [](const ConfigTable&) {}, "f.toml:2", "not valid TOML", "toml.io"},
    {"key twice", "a = 1\na = 2\n", [](const ConfigTable&) {}, "f.toml:2", "not valid TOML", "toml.io"},
    {"missing key", "x = 1\n", read_ratio, "f.toml:1: ratio", "is missing", "from 0 to 1"},
    {"missing in a table", "\n[sun]\n", [](const ConfigTable& t) { t.table("sun").text("kind"); },
     "f.toml:2: sun.kind", "is missing", "text in quotes"},
    {"missing table", "x = 1\n", [](const ConfigTable& t) { t.table("sun"); }, "f.toml:1: sun", "is missing",
     "[sun]"},
    {"text for number", "ratio = \"half\"\n", read_ratio, "f.toml:1: ratio", "is a text", "from 0 to 1"},
    {"boolean for number", "ratio = true\n", read_ratio, "f.toml:1: ratio", "is a boolean", "number"},
    {"date for number", "ratio = 2020-01-01\n", read_ratio, "f.toml:1: ratio", "is a date", "number"},
    {"number for text", "name = 3\n", [](const ConfigTable& t) { t.text("name"); }, "f.toml:1: name",
     "is an integer", "text in quotes"},
    {"number for boolean", "dense = 1\n", [](const ConfigTable& t) { t.boolean("dense"); }, "f.toml:1: dense",
     "is an integer", "true or false"},
    {"float for integer", "n = 2.0\n", [](const ConfigTable& t) { t.integer("n"); }, "f.toml:1: n",
     "is a floating-point number", "integer"},
    {"number for array", "n = 2.0\n", [](const ConfigTable& t) { t.numbers("n"); }, "f.toml:1: n",
     "is a floating-point number", "array"},
    {"text in an array of numbers", "n = [1, \"2\"]\n", [](const ConfigTable& t) { t.numbers("n"); },
     "f.toml:1: n[1]", "is a text", "number"},
    {"number in an array of texts", "n = [\"1\", 2]\n", [](const ConfigTable& t) { t.texts("n"); },
     "f.toml:1: n[1]", "is an integer", "text"},
    {"value for table", "sun = 3\n", [](const ConfigTable& t) { t.table("sun"); }, "f.toml:1: sun",
     "is an integer", "[sun]"},
    {"table for array of tables", "[tree]\n", [](const ConfigTable& t) { t.tables("tree"); },
     "f.toml:1: tree", "is a table", "[[tree]]"},
    {"value in an array of tables", "tree = [1]\n", [](const ConfigTable& t) { t.tables("tree"); },
     "f.toml:1: tree[0]", "is an integer", "[[tree]]"},
    {"below the range", "ratio = -0.1\n", read_ratio, "f.toml:1: ratio", "-0.1", "from 0 to 1"},
    {"above the range", "\n\nratio = 1.5\n", read_ratio, "f.toml:3: ratio", "1.5", "from 0 to 1"},
    {"integer out of range", "n = -2\n", [](const ConfigTable& t) { t.integer("n", {0}); }, "f.toml:1: n",
     "-2", "at least 0"},
    {"item out of range", "n = [1, 9]\n",
     [](const ConfigTable& t) {
       t.numbers("n", {0, 5});
     },
     "f.toml:1: n[1]", "9", "from 0 to 5"},
    {"NaN", "ratio = nan\n", [](const ConfigTable& t) { t.number("ratio"); }, "f.toml:1: ratio", "nan",
     "finite number"},
    {"infinity", "ratio = inf\n", [](const ConfigTable& t) { t.number("ratio"); }, "f.toml:1: ratio", "inf",
     "finite number"},
    {"minus infinity in an array", "n = [-inf]\n", [](const ConfigTable& t) { t.numbers("n"); },
     "f.toml:1: n[0]", "-inf", "finite number"},
    {"no such choice", "kind = \"dic\"\n",
     [](const ConfigTable& t) {
       t.choice("kind", {"point", "disc"});
     },
     "f.toml:1: kind", "\"dic\"", "\"point\", \"disc\""},
    {"unknown key", "species = \"a\"\nheigth_m = 3\n", read_all_known, "f.toml:2: heigth_m",
     "unknown key 'heigth_m'", "did you mean 'height_m'?"},
    {"unknown key that is like nothing", "zzz = 3\n", read_all_known, "f.toml:1: zzz", "unknown key 'zzz'",
     "known here: height_m, species, sun, tree"},
    {"unknown key in a table", "[sun]\nelevation = 3\n", read_all_known, "f.toml:2: sun.elevation",
     "unknown key 'elevation'", "did you mean 'elevation_deg'?"},
    {"unknown table", "[snu]\n", read_all_known, "f.toml:1: snu", "unknown key 'snu'", "did you mean 'sun'?"},
    {"unknown key in an array of tables", "[[tree]]\nheight_m = 1\n[[tree]]\nheigt_m = 1\n", read_all_known,
     "f.toml:4: tree[1].heigt_m", "unknown key 'heigt_m'", "did you mean 'height_m'?"},
};

class ConfigMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(ConfigMistakes, AreRefusedWithPlaceAndRemedy) {
  const Mistake& mistake = GetParam();
  try {
    mistake.read(ConfigTable::from_text(mistake.text, "f.toml"));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_EQ(error.where(), mistake.where);
    EXPECT_NE(error.problem().find(mistake.problem), std::string::npos) << error.problem();
    EXPECT_NE(error.remedy().find(mistake.remedy), std::string::npos) << error.remedy();
  }
}
INSTANTIATE_TEST_SUITE_P(Each, ConfigMistakes, testing::ValuesIn(kMistakes));

TEST(ConfigTable, AFolderIsSaidToBeOne) {
  try {
    ConfigTable::from_file(test::scratch_dir());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), test::scratch_dir().string());
    EXPECT_EQ(error.problem(), "is a folder, not a file");
  }
}

TEST(ConfigTable, MissingFileOrFolderIsNotFound) {
  for (const auto& path : {test::scratch_dir() / "absent.toml", test::scratch_dir()}) {
    try {
      ConfigTable::from_file(path);
      FAIL() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kNotFound);
      EXPECT_EQ(error.where(), path.string());
    }
  }
}

std::string key_of_parts(std::size_t parts) {
  std::string key = "a";
  for (std::size_t i = 1; i < parts; ++i) key += ".a";
  return key;
}

// A key of 200,000 parts made the parser overflow its stack; dots that are no keys do not count.
TEST(ConfigTable, KeysOfVeryManyPartsAreRefused) {
  for (const std::string& line :
       {key_of_parts(200'000) + " = 1", "[" + key_of_parts(65) + "]", "x = {" + key_of_parts(65) + " = 1}",
        "\"=\\\"\"." + key_of_parts(65) + "=1"}) {
    try {
      ConfigTable::from_text("b = 1\n" + line + "\n", "f.toml");
      FAIL() << "accepted: " << line.substr(0, 40);
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "f.toml:2");
      EXPECT_NE(error.problem().find("more than 64 parts"), std::string::npos) << error.problem();
    }
  }
  std::string numbers = "0.5";
  for (int i = 0; i < 200; ++i) numbers += ", 0.5";
  EXPECT_NO_THROW(ConfigTable::from_text("# " + std::string(300, '.') + "\na = \"" + std::string(300, '.') +
                                             "\"\nb = [" + numbers + "]\nk." + key_of_parts(63) + "=1\n",
                                         "f.toml"));
}

TEST(ConfigTable, AFileWithoutEndIsRefused) {
  try {
    ConfigTable::from_file("/dev/zero");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded);
  }
}

TEST(ConfigTable, FileKnowsItsFolderAndLine) {
  const auto path = test::scratch_dir() / "scene.toml";
  std::ofstream(path) << "# head\nratio = 2\n";
  const ConfigTable table = ConfigTable::from_file(path);
  EXPECT_EQ(table.directory(), test::scratch_dir());
  EXPECT_EQ(table.where("ratio"), path.string() + ":2: ratio");
}

TEST(ConfigTable, AskingWhetherAKeyExistsIsNotReading) {
  const ConfigTable table = ConfigTable::from_text("a = 1\n", "t");
  EXPECT_TRUE(table.has("a"));
  EXPECT_THROW(table.reject_unread(), Error);
}

}  // namespace
}  // namespace sunfleck
