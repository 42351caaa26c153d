#include "geometry_check.h"

#include <gtest/gtest.h>

namespace sunfleck::lsystem {
namespace {

void expect_vector(const Vec3& actual, const nlohmann::json& expected, double tolerance, const char* what) {
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(actual[k], expected[static_cast<std::size_t>(k)].get<double>(), tolerance)
        << what << " component " << k;
}

Vec3 centroid(const Drawing& drawing) {
  Vec3 sum(0);
  for (const Segment& s : drawing.segments) sum += 0.5 * glm::length(s.to_m - s.from_m) * (s.from_m + s.to_m);
  return drawing.total_length_m > 0 ? sum / drawing.total_length_m : sum;
}

}  // namespace

void expect_geometry(const Drawing& drawing, const nlohmann::json& expected) {
  EXPECT_EQ(drawing.segments.size(), expected["segments"].get<std::size_t>());
  EXPECT_EQ(drawing.max_bracket_depth, expected["max_bracket_depth"].get<int>());
  const double length = expected["total_length"];
  EXPECT_NEAR(drawing.total_length_m, length, 1e-6 * std::max(1.0, length));
  const Box bounds = drawing.segments.empty() ? Box{Vec3(0), Vec3(0)} : drawing.bounds;
  const double tolerance = 1e-6 * std::max(1.0, glm::length(bounds.size()));
  expect_vector(bounds.lo, expected["bbox_min"], tolerance, "bbox_min");
  expect_vector(bounds.hi, expected["bbox_max"], tolerance, "bbox_max");
  expect_vector(drawing.end.position_m, expected["end"], tolerance, "end");
  expect_vector(centroid(drawing), expected["length_weighted_centroid"], tolerance, "centroid");
}

}  // namespace sunfleck::lsystem
