// What the reference promises besides numbers: bad input is answered with what would be right, work stops
// when asked, equal input gives equal bytes on any number of threads, targets and limits are kept.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {
namespace {

Forest small_tree() {
  Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 300, 0.15, 3), {Leaf{0.4, 0.3, 0.2}});
  forest.prototypes[0].wood.push_back({{0, 0, 0}, {0, 0, 2}, 0.1f, 0.05f, 0});
  forest.prototypes[0].foliage.push_back(shoot({0, 0, 3.2}, {0.1, 0, 0}, 0.04, 0.02));
  return forest;
}

struct BadInput {
  const char* what;
  std::function<void(Forest&, Illumination&, ReferenceOptions&)> spoil;
  const char *where, *remedy;
  ErrorKind kind = ErrorKind::kInvalidInput;
};

TEST(Reference, BadInputIsAnsweredWithWhatWouldBeRight) {
  const BadInput table[] = {
      {"no trees", [](auto& f, auto&, auto&) { f.instances.clear(); }, "forest", "at least one tree"},
      {"no leaves", [](auto& f, auto&, auto&) { f.prototypes[0].foliage.clear(); }, "forest",
       "at least one tree"},
      {"a leaf at infinity", [](auto& f, auto&, auto&) { f.prototypes[0].foliage[7].centre_m.x = INFINITY; },
       "foliage element 7", "finite"},
      {"no rays", [](auto&, auto&, auto& o) { o.rays_per_face = 0; }, "reference.rays_per_face",
       "1 to 65536"},
      {"too many rays", [](auto&, auto&, auto& o) { o.rays_per_face = 65537; }, "reference.rays_per_face",
       "65536"},
      {"no sun rays", [](auto&, auto&, auto& o) { o.sun_rays_per_element = -3; },
       "reference.sun_rays_per_element", "1 to 65536"},
      {"target NaN", [](auto&, auto&, auto& o) { o.target_relative_error = NAN; }, "target_relative_error",
       "to 1"},
      {"convergence 0", [](auto&, auto&, auto& o) { o.convergence = 0.0; }, "reference.convergence",
       "more than 0"},
      {"no iterations", [](auto&, auto&, auto& o) { o.max_iterations = 0; }, "max_iterations", "1 or more"},
      {"cells of NaN", [](auto&, auto&, auto& o) { o.ground_cell_m = NAN; }, "ground_cell_m", "metres"},
      {"tiny cells", [](auto&, auto&, auto& o) { o.ground_cell_m = 1e-5; }, "ground_cell_m", "4 million",
       ErrorKind::kLimitExceeded},
      {"no memory", [](auto&, auto&, auto& o) { o.memory_limit_bytes = 300000; }, "reference.rays_per_face",
       "rays per face, or a higher limit", ErrorKind::kLimitExceeded},
      {"a sun of NaN", [](auto&, auto& l, auto&) { l.to_sun.x = NAN; }, "illumination.to_sun", "direction"},
      {"a beam below 0", [](auto&, auto& l, auto&) { l.bands[0].beam_normal_w_m2 = -1; }, "beam_normal_w_m2",
       "W m-2"},
      {"a band too many", [](auto&, auto& l, auto&) { l.bands.push_back({}); }, "illumination.bands",
       "one for each"},
  };
  for (const BadInput& bad : table) {
    SCOPED_TRACE(bad.what);
    Forest forest = small_tree();
    const OpticsTable optics = optics_of(forest, 0.2);
    Illumination light = sunlight({1, 0, 2}, 400, 100);
    ReferenceOptions options;
    bad.spoil(forest, light, options);
    try {
      reference_light_map(forest, optics, light, options, {});
      ADD_FAILURE() << "was accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), bad.kind);
      EXPECT_NE(e.where().find(bad.where), std::string::npos) << e.where();
      EXPECT_NE(e.remedy().find(bad.remedy), std::string::npos) << e.remedy();
      EXPECT_FALSE(e.problem().empty());
    }
  }
}

// Every number of the answer as bytes.
std::vector<float> numbers(const LightMap& map) {
  std::vector<float> all = map.sunlit_fraction;
  for (const BandLightMap& b : map.bands) {
    const auto* first = reinterpret_cast<const float*>(b.elements.data());
    all.insert(all.end(), first, first + b.elements.size() * sizeof(ElementLight) / sizeof(float));
    all.insert(all.end(), b.standard_error_w_m2.begin(), b.standard_error_w_m2.end());
    for (const double x : {b.budget.escaped_w, b.budget.residual_w, b.budget.residual_standard_error_w,
                           b.trees[0].absorbed_standard_error_w, b.mean_irradiance_w_m2})
      all.push_back(static_cast<float>(x));
  }
  return all;
}

TEST(Reference, SameBytesOnAnyNumberOfThreads) {
  const Forest forest = small_tree();
  std::vector<float> one, two, other_seed;
  const Illumination light = sunlight({1, 0, 2}, 400, 100);
  with_threads(1, [&] { one = numbers(trace_light(forest, 0.2, light, {})); });
  with_threads(2, [&] { two = numbers(trace_light(forest, 0.2, light, {})); });
  ReferenceOptions o;
  o.seed = 2;
  other_seed = numbers(trace_light(forest, 0.2, light, o));
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(float)), 0);
  EXPECT_NE(std::memcmp(one.data(), other_seed.data(), one.size() * sizeof(float)), 0);
}

TEST(Reference, DoublesRaysUntilTheTargetIsMet) {
  const Forest forest = small_tree();
  ReferenceOptions o;
  o.rays_per_face = o.sun_rays_per_element = 8;
  o.target_relative_error = 0.02;
  const LightMap map = trace_light(forest, 0.2, sunlight({1, 0, 2}, 400, 100), o);
  double squares = 0.0;
  for (const float e : map.bands[0].standard_error_w_m2) squares += e * e / 301.0;
  EXPECT_LE(std::sqrt(squares), 0.02 * map.bands[0].mean_irradiance_w_m2);
  EXPECT_TRUE(map.provenance.notes.size() == 1) << "only that shoots scatter alike";
  EXPECT_NE(map.provenance.settings[0].second, "8");

  o.max_rays_per_face = 16;
  const LightMap short_of_it = trace_light(forest, 0.2, sunlight({1, 0, 2}, 400, 100), o);
  EXPECT_EQ(short_of_it.provenance.settings[0].second, "16");
  EXPECT_NE(short_of_it.provenance.notes[0].find("not reached"), std::string::npos);
}

// Rays added in rounds are the rays of one round.
TEST(Reference, RoundsAddUp) {
  const Forest forest = small_tree();
  const Illumination light = skylight(100.0);
  ReferenceOptions rounds, once;
  rounds.rays_per_face = 8;
  rounds.target_relative_error = 1e-6;
  rounds.max_rays_per_face = 64;
  once.rays_per_face = 64;
  const std::vector<float> a = numbers(trace_light(forest, 0.2, light, rounds)),
                           b = numbers(trace_light(forest, 0.2, light, once));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5 * std::abs(b[i]) + 1e-6);
}

TEST(Reference, StopsWithinMilliseconds) {
  const Forest forest =
      forest_of(random_leaves(Crown::kSphere, {0, 0, 2}, Vec3(1), 40000, 0.02, 3), {Leaf{0.4, 0.4}});
  const OpticsTable optics = optics_of(forest, 0.2);
  ReferenceOptions o;
  o.rays_per_face = 256;
  for (const char* stage : {"tracing rays", "tracing sun", "iterating"}) {
    std::stop_source source;
    using Clock = std::chrono::steady_clock;
    std::atomic<Clock::rep> asked{0};
    RunControl control;
    control.stop = source.get_token();
    control.progress = [&](std::string_view now, double fraction) {
      if (now != stage || fraction < (now == "iterating" ? 0.0 : 0.01) || source.stop_requested()) return;
      asked = Clock::now().time_since_epoch().count();
      source.request_stop();
    };
    if (std::string_view(stage) != "tracing rays") o.rays_per_face = 32;
    try {
      reference_light_map(forest, optics, sunlight({1, 0, 2}, 400, 100), o, control);
      ADD_FAILURE() << "did not stop";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::kCancelled);
    }
    const std::chrono::duration<double> took =
        Clock::now().time_since_epoch() - Clock::duration(asked.load());
    // 10 ms of work between two looks, and as much again for a machine shared with others.
    EXPECT_LT(took.count(), 0.05) << stage;
  }
}

TEST(Reference, SaysWhatItDid) {
  const Forest forest = small_tree();
  const LightMap map = trace_light(forest, 0.2, skylight(100.0), {});
  const Provenance& p = map.provenance;
  EXPECT_EQ(p.method, "reference");
  EXPECT_EQ(p.forest_hash, content_hash(forest));
  EXPECT_EQ(p.seed, 1u);
  ASSERT_EQ(p.skipped.size(), 1u);
  EXPECT_EQ(p.skipped[0].what, "direct sun");
  std::string stages;
  for (const StageTime& t : p.times) stages += t.stage + ";";
  EXPECT_EQ(stages, "building ray scene;tracing rays;iterating;");
  EXPECT_EQ(map.bands[0].elements.size(), 301u);
  EXPECT_EQ(map.bands[0].trees.size(), 1u);
  EXPECT_GT(map.bands[0].trees[0].absorbed_standard_error_w, 0.0);
}

TEST(Reference, OneRayGivesNoErrorAndSaysSo) {
  ReferenceOptions o;
  o.rays_per_face = 1;
  const LightMap map = trace_light(small_tree(), 0.2, skylight(100.0), o);
  EXPECT_TRUE(map.bands[0].standard_error_w_m2.empty());
  EXPECT_NE(map.provenance.notes[0].find("no standard error"), std::string::npos);
}

}  // namespace
}  // namespace sunfleck::test
