// The stability report: every method on the stress list of scenes without a NaN, and closed forms that keep
// their digits where the printed ones lose them.
#include "lighting/bench/stability.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

bool is_printed(const StabilityRow& row) {
  return row.form.find("as printed") != std::string::npos || row.form.find("acos") != std::string::npos;
}

TEST(EnvelopeForms, KeepTheirDigits) {
  for (const StabilityRow& row : envelope_form_stability()) {
    if (is_printed(row)) continue;
    EXPECT_GT(row.points, 100u) << row.form;
    EXPECT_EQ(row.not_finite, 0u) << row.form << ", " << row.precision << " at " << row.worst_at;
    // What the project promises for its vectors: 1e-13 in double, 4e-6 in float.
    EXPECT_LE(row.worst_relative_error, row.precision == "double" ? 1e-13 : 4e-6)
        << row.form << ", " << row.precision << " at " << row.worst_at;
  }
}

TEST(PrintedForms, LoseWhatOursKeep) {
  std::size_t printed = 0;
  for (const StabilityRow& row : envelope_form_stability()) {
    if (!is_printed(row)) continue;
    ++printed;
    EXPECT_TRUE(row.not_finite > 0 || row.worst_relative_error > 1e-2)
        << row.form << ", " << row.precision << ": " << row.worst_relative_error;
  }
  EXPECT_EQ(printed, 12u);  // six in each precision: else this test has lost its subject
}

TEST(SlabForms, StandBesideTheirPrintedTwins) {
  std::size_t ours = 0, printed = 0, lost = 0;
  for (const StabilityRow& row : slab_form_rows()) {
    if (is_printed(row)) {
      ++printed;
      lost += row.not_finite > 0 || row.worst_relative_error > 1e-2;
    } else {
      ++ours;
      EXPECT_EQ(row.not_finite, 0u) << row.form << ", " << row.precision;
    }
  }
  EXPECT_GE(ours, 4u);
  EXPECT_GE(printed, 1u);
  EXPECT_GT(lost, 0u);
}

class StressScenes : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryMethod, StressScenes, testing::ValuesIn(method_names()),
                         [](const auto& one) { return one.param; });

TEST_P(StressScenes, GiveFiniteLightOrAClearRefusal) {
  const auto rows = run_stability(stability_scenes(), {GetParam()}, {});
  std::size_t refused = 0, compared = 0;
  for (const SceneStability& row : rows) {
    EXPECT_EQ(row.not_finite, 0u) << row.scene;
    EXPECT_EQ(row.negative, 0u) << row.scene;
    EXPECT_EQ(row.violation, "") << row.scene;
    EXPECT_EQ(row.refused.empty(), !row.should_be_refused) << row.scene << ": " << row.refused;
    EXPECT_TRUE(row.as_expected()) << row.scene << ": " << row.figure << " " << row.found << ", expected "
                                   << row.expected << ", difference " << row.difference;
    refused += row.should_be_refused;
    compared += row.has_expectation;
  }
  EXPECT_GE(refused, 20u);
  EXPECT_GE(compared, 15u);
}

TEST(StabilityReport, HasALinePerEntry) {
  const auto all = stability_scenes();
  const std::vector<StabilityScene> few(all.begin(), all.begin() + 2);
  const auto rows = run_stability(few, {"envelope", "single_scattering"}, {});
  ASSERT_EQ(rows.size(), 4u);
  const std::string csv = stability_csv(rows);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
  const auto forms = envelope_form_stability();
  const std::string form_csv = stability_csv(forms);
  EXPECT_EQ(std::ranges::count(form_csv, '\n'), static_cast<std::ptrdiff_t>(forms.size() + 1));
  const std::string table = stability_table(rows, forms);
  EXPECT_NE(table.find("single_scattering"), std::string::npos);
  EXPECT_NE(table.find("phi(x), as printed"), std::string::npos);
}

TEST(StabilityReport, CallsAFailureAFailure) {
  SceneStability row;
  EXPECT_TRUE(row.as_expected());
  row.not_finite = 1;
  EXPECT_FALSE(row.safe());
  row = {};
  row.should_be_refused = true;
  EXPECT_FALSE(row.safe());
  row.refused = "light: no";
  EXPECT_TRUE(row.safe());
  row = {};
  row.has_expectation = true;
  row.difference = 0.1;
  row.allowed = 0.05;
  EXPECT_TRUE(row.safe());
  EXPECT_FALSE(row.as_expected());
}

TEST(StabilityReport, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(run_stability({.stop = source.get_token(), .progress = {}}), Error);
}

}  // namespace
}  // namespace sunfleck
