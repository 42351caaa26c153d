// A session answers with the same bytes as a call by itself, whatever was asked before, keeps what may be
// kept and nothing else, and stays within its budget.
#include "lighting/plan/light_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <thread>
#include <utility>

#include "sim/base/error.h"
#include "sim/forest/generated_scenes.h"

namespace sunfleck {
namespace {

Forest crown() {
  return generated_crown({.kind = CrownKind::kClumped, .leaves = 500, .crown_lai = 3, .seed = 4});
}

LightRequest request_for(Method method) {
  LightRequest r;
  r.method = method;
  r.optics = {{"PAR", "NIR"}, {0.1, 0.2}, {}};
  r.light.to_sun = direction_from_azimuth_zenith(1.0, 0.6);
  r.light.sun_half_angle_rad = radians_from_degrees(0.265);
  r.light.bands = {{400, 100}, {300, 80}};
  r.reference.rays_per_face = r.reference.sun_rays_per_element = 16;
  return r;
}

void expect_equal(const LightMap& a, const LightMap& b, const std::string& what) {
  ASSERT_EQ(a.bands.size(), b.bands.size()) << what;
  EXPECT_EQ(a.sunlit_fraction, b.sunlit_fraction) << what;
  for (std::size_t i = 0; i < a.bands.size(); ++i) {
    const BandLightMap &x = a.bands[i], &y = b.bands[i];
    ASSERT_EQ(x.elements.size(), y.elements.size()) << what;
    EXPECT_EQ(std::memcmp(x.elements.data(), y.elements.data(), x.elements.size() * sizeof(ElementLight)), 0)
        << what;
    EXPECT_EQ(x.standard_error_w_m2, y.standard_error_w_m2) << what;
    EXPECT_EQ(x.mean_irradiance_w_m2, y.mean_irradiance_w_m2) << what;
    EXPECT_EQ(x.mean_irradiance_standard_error_w_m2, y.mean_irradiance_standard_error_w_m2) << what;
    EXPECT_EQ(x.budget.residual_w, y.budget.residual_w) << what;
  }
  EXPECT_EQ(a.provenance.settings, b.provenance.settings) << what;
  EXPECT_EQ(a.provenance.notes, b.provenance.notes) << what;
}

// Every kind of change that a session must tell from the others.
std::vector<std::pair<std::string, LightRequest>> changes_of(const LightRequest& base) {
  std::vector<std::pair<std::string, LightRequest>> all = {{"first", base}};
  const auto changed = [&](const char* what, const auto& change) {
    LightRequest r = base;
    change(r);
    all.emplace_back(what, r);
  };
  changed("sun", [](LightRequest& r) { r.light.to_sun = direction_from_azimuth_zenith(2.0, 0.9); });
  changed("disc", [](LightRequest& r) { r.light.sun_half_angle_rad = 0.03; });
  changed("sky", [](LightRequest& r) { r.light.sky = SkyModel::kStandardOvercast; });
  changed("strength", [](LightRequest& r) { r.light.bands[0] = {100, 300}; });
  changed("no sun", [](LightRequest& r) { r.light.bands = {{0, 100}, {0, 80}}; });
  changed("optics", [](LightRequest& r) {
    r.optics.overrides = {{"*", "NIR", {{0.3, 0.3, 0.3, 0.3}, 0.1}}};
  });
  changed("soil", [](LightRequest& r) { r.optics.soil_albedo = {0.5, 0.6}; });
  changed("band", [](LightRequest& r) { r.optics.bands[0] = "VIS"; });
  changed("ground", [](LightRequest& r) { r.reference.ground = false; });
  changed("ground cells", [](LightRequest& r) { r.reference.ground_cell_m = 0.3; });
  changed("seed", [](LightRequest& r) { r.reference.seed = 77; });
  changed("rays", [](LightRequest& r) { r.reference.rays_per_face = 20; });
  changed("target", [](LightRequest& r) { r.reference.target_relative_error = 0.15; });
  changed("knobs", [](LightRequest& r) {
    r.grid.directions = 14;
    r.grid.cell_m = 0.21;
    r.envelope.cell_m = 0.21;
    r.spp.sample_directions = 16;
    r.automatic.tolerance = 0.3;
  });
  all.emplace_back("the first again", base);
  return all;
}

class SessionOfEveryMethod : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, SessionOfEveryMethod, testing::ValuesIn(method_names()),
                         [](const auto& i) { return i.param; });

TEST_P(SessionOfEveryMethod, GivesTheBytesOfACallByItself) {
  const Forest forest = crown();
  const LightSession session(forest);
  for (const auto& [what, request] : changes_of(request_for(method_from_string(GetParam(), "test"))))
    expect_equal(session.compute(request, {}, {}), compute_light_map(forest, request, {}, {}), what);
}

TEST(LightSession, TracesAgainOnlyWhatAChangeTouches) {
  const Forest forest = crown();
  const LightSession session(forest);
  const LightRequest base = request_for(Method::kReference);
  std::uint64_t made = 0;
  const auto makes = [&](const LightRequest& r) {
    const LightMap map = session.compute(r, {}, {});
    const std::uint64_t before = std::exchange(made, session.cached().made);
    return made - before;
  };
  EXPECT_EQ(makes(base), 4u);  // ray scene, surfaces, hits, sun
  EXPECT_EQ(makes(base), 0u);
  for (const auto& [what, request] : changes_of(base)) {
    const std::uint64_t count = makes(request);
    if (what == "sun" || what == "disc" || what == "sky") {
      EXPECT_EQ(count, 1u) << what;  // its rays, or the hits
    } else if (what == "strength" || what == "no sun" || what == "optics" || what == "soil" ||
               what == "band") {
      EXPECT_EQ(count, 0u) << what;
    }
  }
}

TEST(LightSession, StaysWithinItsBudget) {
  const Forest forest = crown();
  const auto cache = std::make_shared<PreparedCache>(300 * 1024);
  const LightSession session(forest, cache);
  for (const auto& [what, request] : changes_of(request_for(Method::kReference))) {
    session.compute(request, {}, {});
    EXPECT_LE(cache->stats().bytes, 300u * 1024) << what;
  }
  EXPECT_GT(cache->stats().dropped, 0u);
}

TEST(LightSession, ForgetsItsThingsWhenItEndsAndOnlyThose) {
  const Forest forest = crown(), other = crown();
  const auto cache = std::make_shared<PreparedCache>(LightSession::kDefaultBytes);
  const LightSession stays(other, cache);
  stays.compute(request_for(Method::kReference), {}, {});
  const auto before = cache->stats();
  {
    const LightSession ends(forest, cache);
    ends.compute(request_for(Method::kReference), {}, {});
    EXPECT_EQ(cache->stats().entries, 2 * before.entries);
  }
  EXPECT_EQ(cache->stats().entries, before.entries);
  EXPECT_EQ(cache->stats().bytes, before.bytes);
}

TEST(LightSession, ServesManyThreadsAndMakesNothingTwice) {
  const Forest forest = crown();
  const LightSession session(forest);
  const LightRequest request = request_for(Method::kReference);
  const LightMap alone = compute_light_map(forest, request, {}, {});
  std::vector<LightMap> maps(6);
  {
    std::vector<std::jthread> threads;
    for (LightMap& map : maps) threads.emplace_back([&] { map = session.compute(request, {}, {}); });
  }
  for (const LightMap& map : maps) expect_equal(map, alone, "thread");
  EXPECT_EQ(session.cached().made, 4u);
}

TEST(PreparedCache, WhoWaitsForAStoppedMakerMakesItHimself) {
  PreparedCache cache(1000);
  const PreparedKey key("thing");
  const auto size = [](const int&) { return std::uint64_t{4}; };
  std::atomic<bool> making{false}, fail{false};
  std::jthread first([&] {
    EXPECT_THROW(cache.get<int>(
                     "", key, {},
                     [&]() -> std::shared_ptr<const int> {
                       making = true;
                       while (!fail) std::this_thread::yield();
                       throw_cancelled();
                     },
                     size),
                 Error);
  });
  while (!making) std::this_thread::yield();
  std::jthread second([&] {
    EXPECT_EQ(*cache.get<int>(
                  "", key, {}, [] { return std::make_shared<const int>(7); }, size),
              7);
  });
  fail = true;
  first.join();
  second.join();
  EXPECT_EQ(cache.stats().made, 1u);
}

TEST(PreparedCache, WaitingCanBeStopped) {
  PreparedCache cache(1000);
  const auto size = [](const int&) { return std::uint64_t{4}; };
  std::atomic<bool> making{false};
  std::stop_source source;
  std::jthread first([&] {
    cache.get<int>(
        "", PreparedKey("thing"), {},
        [&] {
          making = true;
          while (!source.stop_requested()) std::this_thread::yield();
          return std::make_shared<const int>(1);
        },
        size);
  });
  while (!making) std::this_thread::yield();
  source.request_stop();
  EXPECT_THROW(cache.get<int>(
                   "", PreparedKey("thing"), {source.get_token(), {}},
                   [] { return std::make_shared<const int>(2); }, size),
               Error);
}

TEST(PreparedKey, TellsNumbersApartExactly) {
  const auto key = [](double x) { return PreparedKey("x").add("v", x).text(); };
  EXPECT_NE(key(0.1), key(std::nextafter(0.1, 1)));
  EXPECT_EQ(key(0.0), key(-0.0));
  EXPECT_NE(PreparedKey("a").add("v", 1).text(), PreparedKey("b").add("v", 1).text());
}

}  // namespace
}  // namespace sunfleck
