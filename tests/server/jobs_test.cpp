// The pool, the watch, the store and the cache without gRPC.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <latch>
#include <thread>

#include "server/jobs/compute_pool.h"
#include "server/jobs/deadline_watch.h"
#include "server/jobs/light_map_cache.h"
#include "server/jobs/scene_store.h"
#include "sim/base/error.h"

namespace sunfleck {
namespace {

using namespace std::chrono_literals;

// Waits until `done` or five seconds, which no healthy run needs.
template <class Done>
bool eventually(const Done& done) {
  for (int i = 0; i < 5000 && !done(); ++i) std::this_thread::sleep_for(1ms);
  return done();
}

TEST(ComputePool, EveryJobIsRunOrAbandonedExactlyOnce) {
  std::atomic<int> ran{0}, abandoned{0}, refused{0};
  {
    ComputePool pool(3, 20);
    std::vector<std::jthread> senders;
    for (int s = 0; s < 4; ++s) {
      senders.emplace_back([&] {
        for (int i = 0; i < 500; ++i) {
          std::stop_source stop;
          if (i % 3 == 0) stop.request_stop();
          if (!pool.try_submit({[&] { ++ran; }, [&] { ++abandoned; }, stop.get_token()})) ++refused;
        }
      });
    }
    senders.clear();  // joins
    // With slow workers all 2000 may have been refused or abandoned: one more, offered until there is room,
    // must run.
    bool taken = false;
    EXPECT_TRUE(eventually([&] {
      if (!taken) taken = pool.try_submit({[&] { ++ran; }, [&] { ++abandoned; }, {}});
      return taken;
    }));
    EXPECT_TRUE(eventually([&] { return ran > 0; }));
  }
  EXPECT_EQ(ran + abandoned + refused, 2001);
}

TEST(ComputePool, HoldsWorkersAndQueueAndNoMore) {
  std::latch release(1);
  std::atomic<int> done{0};
  ComputePool pool(2, 3);
  const auto submit = [&] {
    return pool.try_submit({[&] {
                              release.wait();
                              ++done;
                            },
                            [] {},
                            {}});
  };
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(submit()) << i;
  EXPECT_FALSE(submit());
  EXPECT_EQ(pool.load().running, 2u);
  EXPECT_EQ(pool.load().queued, 3u);
  release.count_down();
  EXPECT_TRUE(eventually([&] { return done == 5 && pool.load().running == 0; }));
  EXPECT_TRUE(submit());
  EXPECT_TRUE(eventually([&] { return done == 6; }));
}

TEST(ComputePool, StoppedJobsMakeRoom) {
  std::latch release(1);
  std::atomic<int> abandoned{0};
  ComputePool pool(1, 1);
  std::stop_source stop;
  ASSERT_TRUE(pool.try_submit({[&] { release.wait(); }, [] {}, {}}));
  ASSERT_TRUE(eventually([&] { return pool.load().running == 1; }));
  ASSERT_TRUE(pool.try_submit({[] {}, [&] { ++abandoned; }, stop.get_token()}));
  EXPECT_FALSE(pool.try_submit({[] {}, [] {}, {}}));
  stop.request_stop();
  EXPECT_TRUE(pool.try_submit({[] {}, [] {}, {}}));
  EXPECT_EQ(abandoned, 1);
  release.count_down();
}

TEST(DeadlineWatch, CallsInTimeOnceAndNotWhenRemovedOrMoved) {
  DeadlineWatch watch;
  const auto start = DeadlineWatch::Clock::now();
  std::promise<DeadlineWatch::Clock::time_point> first;
  std::atomic<int> removed{0}, moved{0};
  const auto gone = watch.add(start + 20ms, [&] { ++removed; });
  const auto late = watch.add(start + 20ms, [&] { ++moved; });
  watch.add(start + 50ms, [&] { first.set_value(DeadlineWatch::Clock::now()); });
  watch.remove(gone);
  watch.move(late, start + 10min);
  const auto called = first.get_future().get();
  EXPECT_GE(called, start + 50ms);
  EXPECT_LE(called, start + 500ms);
  EXPECT_EQ(removed, 0);
  EXPECT_EQ(moved, 0);
  watch.move(late, DeadlineWatch::Clock::now());  // earlier: the thread must wake
  EXPECT_TRUE(eventually([&] { return moved == 1; }));
}

ScenePtr scene(const std::string& name, std::uint64_t bytes) {
  auto made = std::make_shared<StoredScene>();
  made->name = name;
  made->memory_bytes = bytes;
  return made;
}

TEST(SceneStore, KeepsWithinItsBudgetAndTellsWhatIsFree) {
  SceneStore store(100);
  store.add(scene("scenes/a", 60));
  try {
    store.add(scene("scenes/b", 41));
    ADD_FAILURE() << "beyond the budget";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kLimitExceeded);
    EXPECT_NE(error.problem().find("40 of 100 are free"), std::string::npos) << error.what();
  }
  store.add(scene("scenes/b", 40));
  EXPECT_EQ(store.bytes(), 100u);
  EXPECT_EQ(store.add(scene("scenes/a", 60)), store.find("scenes/a"));  // there already: nothing is needed
  store.remove("scenes/a");
  EXPECT_EQ(store.bytes(), 40u);
  EXPECT_THROW(store.find("scenes/a"), Error);
}

LightMapPtr map_of(std::size_t elements) {
  auto map = std::make_shared<LightMap>();
  map->sunlit_fraction.resize(elements);  // 4 bytes each
  return map;
}

TEST(LightMapCache, ForgetsTheLeastRecentlyUsedFirst) {
  LightMapCache cache(100);
  cache.add("s", "1", map_of(10));
  cache.add("s", "2", map_of(10));
  EXPECT_TRUE(cache.find("s", "1"));  // now 2 is the older one
  cache.add("s", "3", map_of(10));
  EXPECT_TRUE(cache.find("s", "1"));
  EXPECT_FALSE(cache.find("s", "2"));
  EXPECT_TRUE(cache.find("s", "3"));
  EXPECT_FALSE(cache.find("t", "3"));
  EXPECT_EQ(cache.bytes(), 80u);
  cache.add("s", "4", map_of(1000));  // larger than the whole: not kept, and nothing is lost for it
  EXPECT_EQ(cache.size(), 2u);
  cache.forget_scene("s");
  EXPECT_EQ(cache.bytes(), 0u);
}

}  // namespace
}  // namespace sunfleck
