// The classic systems of tests/golden/lsystem.json that are lists of rules: string, SHA-256, counts and
// geometry of every derivation step must be those of the vectors. Tolerances: strings exact, geometry 1e-6.
#include <gtest/gtest.h>

#include <map>

#include "conformance_grammar.h"
#include "geometry_check.h"
#include "sim/base/sha256.h"
#include "sim/lsystem/lsystem.h"
#include "tests/support/golden.h"

namespace sunfleck::lsystem {
namespace {

bool is_rule_list(const nlohmann::json& one) {
  return one.contains("rules") && !one["rules"].empty() && one["rules"][0].is_object();
}

std::vector<nlohmann::json> rule_list_cases(const std::string& with_key = "id") {
  std::vector<nlohmann::json> result;
  const nlohmann::json file = test::golden("lsystem.json");
  for (const auto& one : file["cases"])
    if (is_rule_list(one) && one.contains(with_key)) result.push_back(one);
  return result;
}

std::map<std::string, std::size_t> count_symbols(const Grammar& grammar, const ModuleString& string) {
  std::map<std::string, std::size_t> counts;
  for (std::size_t i = 0; i < string.size(); ++i) ++counts[grammar.symbol_names()[string.symbol(i)]];
  return counts;
}

void expect_string(const Grammar& grammar, const ModuleString& string, const nlohmann::json& expected) {
  EXPECT_EQ(string.size(), expected["modules"].get<std::size_t>());
  EXPECT_EQ(count_symbols(grammar, string), (expected["counts"].get<std::map<std::string, std::size_t>>()));
  const std::string text = grammar.print(string);
  if (expected.contains("string")) {
    EXPECT_EQ(text, expected["string"].get<std::string>());
  }
  EXPECT_EQ(text.size(), expected["string_chars"].get<std::size_t>());
  EXPECT_EQ(sha256_hex(text), expected["sha256"].get<std::string>());
}

class Conformance : public testing::TestWithParam<nlohmann::json> {};

TEST_P(Conformance, EveryStepHasTheStringAndTheGeometryOfTheVectors) {
  const Grammar grammar = Grammar::parse(grammar_text(GetParam()), "golden");
  ModuleString string = grammar.axiom();
  ASSERT_FALSE(GetParam()["expected"].empty());
  for (const auto& expected : GetParam()["expected"]) {
    const int n = expected["n"];
    SCOPED_TRACE("n = " + std::to_string(n));
    if (n > 0) string = grammar.derive_step(string, n - 1, {});
    expect_string(grammar, string, expected);
    if (expected.contains("geometry"))
      expect_geometry(grammar.interpret(string, StartFrame::kAbop), expected["geometry"]);
  }
}

class TropismConformance : public testing::TestWithParam<nlohmann::json> {};

TEST_P(TropismConformance, TropismBendsAsPublished) {
  const auto& tropism = GetParam()["published_tropism"];
  std::string text = "tropism: ";
  for (std::size_t k = 0; k < 3; ++k) text += (k > 0 ? ", " : "") + tropism["T"][k].dump();
  text += "\nelasticity: " + tropism["e"].dump() + "\n" + grammar_text(GetParam());
  const Grammar grammar = Grammar::parse(text, "golden");
  DeriveOptions options;
  options.steps = 6;
  expect_geometry(grammar.interpret(grammar.derive(options), StartFrame::kAbop),
                  GetParam()["expected_with_tropism_n6"]);
}

std::string case_name(const testing::TestParamInfo<nlohmann::json>& one) {
  return one.param["id"].get<std::string>();
}
INSTANTIATE_TEST_SUITE_P(Golden, Conformance, testing::ValuesIn(rule_list_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Golden, TropismConformance,
                         testing::ValuesIn(rule_list_cases("expected_with_tropism_n6")), case_name);

// All 48 are tested: 42 here, the six that are descriptions in special_cases_test.cpp.
TEST(ConformanceSuite, CoversAllCases) {
  EXPECT_EQ(rule_list_cases().size(), 42u);
  EXPECT_EQ(test::golden("lsystem.json")["cases"].size(), 48u);
}

}  // namespace
}  // namespace sunfleck::lsystem
