// Requests that the links method refuses, each naming what is wrong, before work is done.
#include <gtest/gtest.h>

#include "sim/base/error.h"
#include "tests/lighting/links/links_light.h"

namespace sunfleck::test {
namespace {

void expect_refusal(const Forest& forest, const LinksOptions& options, ErrorKind kind,
                    const std::string& where) {
  try {
    links_light(forest, 0.1, skylight(1), options);
    ADD_FAILURE() << "taken: " << where;
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind);
    EXPECT_EQ(e.where(), where);
    EXPECT_FALSE(e.remedy().empty());
  }
}

TEST(LinksOptions, OutOfRange) {
  const Forest forest = small_crown(20);
  const auto bad = [&](const LinksOptions& o, const std::string& field) {
    expect_refusal(forest, o, ErrorKind::kInvalidInput, "links." + field);
  };
  bad({.links_per_face = 15}, "links_per_face");
  bad({.links_per_face = 257}, "links_per_face");
  bad({.sun_rays_per_element = 0}, "sun_rays_per_element");
  bad({.convergence = 0}, "convergence");
  bad({.convergence = std::nan("")}, "convergence");
  bad({.max_iterations = 0}, "max_iterations");
  bad({.ground_cell_m = -1}, "ground_cell_m");
  expect_refusal(forest, {.ground_cell_m = 1e-6}, ErrorKind::kLimitExceeded, "links.ground_cell_m");
}

TEST(LinksOptions, TooLargeForItsMemory) {
  const Forest forest = small_crown(200);
  expect_refusal(forest, {.memory_limit_bytes = 100000}, ErrorKind::kLimitExceeded, "links.links_per_face");
  // Enough for the tree and for its rays, not for 400 copies of the rays that leave it.
  Forest stand = forest;
  for (int i = 1; i < 400; ++i)
    stand.instances.push_back({{3.0 * (i % 20), 3.0 * (i / 20), 0}, {}, 0, 1, {}});
  expect_refusal(stand, {.ground = false, .memory_limit_bytes = 12000000}, ErrorKind::kLimitExceeded,
                 "links.links_per_face");
}

TEST(LinksOptions, StatedMemoryIsWhatIsUsed) {
  const Forest forest = small_crown(600);
  const LinksPrepared p = prepare_links(forest, {.ground = false}, {});
  const double faces = 2 * 600;
  EXPECT_NEAR(static_cast<double>(p.table.bytes()), faces * (4 * 64 + 24 + 12), 0.02 * faces * 292);
}

TEST(LinksOptions, NoFoliage) {
  Forest forest = small_crown(1);
  forest.prototypes[0].foliage.clear();
  EXPECT_THROW(prepare_links(forest, {}, {}), Error);
}

TEST(LinksOptions, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  const RunControl stopped{source.get_token(), {}};
  EXPECT_THROW(prepare_links(small_crown(20), {}, stopped), Error);
}

TEST(LinksOptions, NightSkipsTheSun) {
  const Forest forest = small_crown(20);
  const LightMap map = links_light(forest, 0.1, sunlight({0, 1, -0.1}, 100, 5));
  ASSERT_EQ(map.provenance.skipped.size(), 1u);
  EXPECT_EQ(map.provenance.skipped[0].what, "direct sun");
  for (const ElementLight& e : map.bands[0].elements) EXPECT_EQ(e.front.direct_w_m2 + e.back.direct_w_m2, 0);
}

}  // namespace
}  // namespace sunfleck::test
