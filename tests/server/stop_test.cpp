// What ends a call before its time: the client, its deadline, a full queue, a reader that stalls, and
// SIGTERM.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "sim/base/error.h"
#include "tests/server/running_stream.h"

namespace sunfleck::test {
namespace {

using Clock = std::chrono::steady_clock;

#ifdef SUNFLECK_UNSANITIZED
constexpr double kStopWithin_s = 0.100;
#else
constexpr double kStopWithin_s = 2.0;  // a sanitizer's build is many times slower
#endif

TEST(Stop, CancelFreesTheWorkerWithin100ms) {
  ServedProcess server("running_calls = 1\n");
  Client client = server.client();
  const std::string scene = big_scene(client);
  std::vector<double> freed_s;
  for (int i = 0; i < 20; ++i) {
    RunningStream stream(server, scene);
    ASSERT_TRUE(stream.wait_for_header());
    ASSERT_EQ(load_of(client, "running_calls"), 1u);
    // Different moments of the computation.
    std::this_thread::sleep_for(std::chrono::milliseconds(15 * i));
    const auto cancelled = Clock::now();
    stream.context.TryCancel();
    ASSERT_GE(wait_for_load(client, "running_calls", 0, 30), 0.0);
    freed_s.push_back(seconds_since(cancelled));
    EXPECT_EQ(stream.drain().error_code(), grpc::StatusCode::CANCELLED);
  }
  std::sort(freed_s.begin(), freed_s.end());
  std::printf("worker free after a cancel: median %.1f ms, worst of 20 %.1f ms\n", freed_s[10] * 1e3,
              freed_s.back() * 1e3);
  EXPECT_LE(freed_s[10], kStopWithin_s);
  EXPECT_NO_THROW(client.light_map(scene, noon(Method::kEnvelope)));
}

TEST(Stop, StopTokenOfTheClientLibraryCancels) {
  ServedProcess server("running_calls = 1\n");
  Client client = server.client();
  const std::string scene = big_scene(client);
  std::stop_source stop;
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop.request_stop();
  });
  try {
    client.light_map(scene, slow_request(), {stop.get_token(), {}});
    ADD_FAILURE() << "the call was not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled) << error.what();
  }
  EXPECT_GE(wait_for_load(client, "running_calls", 0, 5), 0.0);
}

TEST(Stop, DeadlineOfTheClientFreesTheWorker) {
  ServedProcess server("running_calls = 1\n");
  Client client = server.client();
  const std::string scene = big_scene(client);
  RunningStream warm(server, scene);  // the connection is made before the clock runs
  ASSERT_TRUE(warm.wait_for_header());
  warm.context.TryCancel();
  warm.drain();
  ASSERT_GE(wait_for_load(client, "running_calls", 0, 5), 0.0);

  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(300));
  const auto start = Clock::now();
  auto reader = warm.stub->StreamLightMap(&context, slow_message(scene));
  v1::StreamLightMapResponse part;
  while (reader->Read(&part)) continue;
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  ASSERT_GE(wait_for_load(client, "running_calls", 0, 30), 0.0);
  const double after_s = seconds_since(start) - 0.3;
  std::printf("worker free %.1f ms after the deadline\n", after_s * 1e3);
  EXPECT_LE(after_s, kStopWithin_s);
}

TEST(Stop, ServersOwnDeadlineIsToldInTheAnswer) {
  ServedProcess server("longest_deadline_s = 0.2\ndefault_deadline_s = 0.2\n");
  Client client = server.client();
  const std::string scene = big_scene(client);
  RunningStream stream(server, scene);  // states no deadline
  const grpc::Status status = stream.drain();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED) << status.error_message();
  EXPECT_NE(status.error_message().find("deadline"), std::string::npos) << status.error_message();
}

TEST(Stop, FullPoolRefusesAtOnceAndSaysWhenToComeBack) {
  ServedProcess server("running_calls = 1\nqueued_calls = 1\n");
  Client client = server.client();
  const std::string scene = big_scene(client);
  RunningStream running(server, scene);
  ASSERT_TRUE(running.wait_for_header());
  RunningStream queued(server, scene);
  ASSERT_GE(wait_for_load(client, "queued_calls", 1, 5), 0.0);

  RunningStream probe(server, scene);
  grpc::Status refused = probe.drain();  // makes the connection, too
  const auto start = Clock::now();
  grpc::ClientContext context;
  auto reader = probe.stub->StreamLightMap(&context, slow_message(scene));
  v1::StreamLightMapResponse part;
  EXPECT_FALSE(reader->Read(&part));
  refused = reader->Finish();
  const double refused_s = seconds_since(start);
  std::printf("refused within %.1f ms\n", refused_s * 1e3);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
#ifdef SUNFLECK_UNSANITIZED
  EXPECT_LE(refused_s, 0.050);
#endif
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(refused.error_details()));
  bool has_retry = false, has_reason = false;
  for (const auto& detail : details.details()) {
    google::rpc::RetryInfo retry;
    google::rpc::ErrorInfo info;
    if (detail.UnpackTo(&retry)) has_retry = retry.retry_delay().seconds() >= 1;
    if (detail.UnpackTo(&info)) has_reason = info.reason() == "SERVER_BUSY" && info.domain() == "sunfleck";
  }
  EXPECT_TRUE(has_retry);
  EXPECT_TRUE(has_reason);

  // A queued call that is cancelled leaves its place at once; then all is free again.
  queued.context.TryCancel();
  EXPECT_GE(wait_for_load(client, "queued_calls", 0, 5), 0.0);
  EXPECT_EQ(load_of(client, "running_calls"), 1u);
  running.context.TryCancel();
  EXPECT_GE(wait_for_load(client, "running_calls", 0, 5), 0.0);
  EXPECT_NO_THROW(client.light_map(scene, noon(Method::kEnvelope)));
}

// How long a reader may take nothing. A sanitizer makes a good reader slow: 0.5 s of it cut off both.
#ifdef SUNFLECK_UNSANITIZED
constexpr int kStalled_ms = 500;
#else
constexpr int kStalled_ms = 5000;
#endif

TEST(Stop, StalledReaderIsCutOffAndOthersAreServed) {
  ServedProcess server("stalled_write_s = " + std::to_string(kStalled_ms / 1000.0) + "\n");
  Client client = server.client();
  const std::string scene =
      client.create_scene(row_of_trees(5, 20000)).name;  // 6 MB: more than a window holds
  const auto stub = v1::LightService::NewStub(server.channel());
  v1::StreamLightMapRequest message;
  message.set_scene(scene);
  fill_message(noon(Method::kEnvelope), *message.mutable_light());
  grpc::ClientContext context;
  auto reader = stub->StreamLightMap(&context, message);
  v1::StreamLightMapResponse part;
  ASSERT_TRUE(reader->Read(&part));  // and then nothing more
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_NO_THROW(client.light_map(scene, noon(Method::kEnvelope)));
  std::this_thread::sleep_for(std::chrono::milliseconds(3 * kStalled_ms));
  while (reader->Read(&part)) continue;
  EXPECT_FALSE(reader->Finish().ok());
}

}  // namespace
}  // namespace sunfleck::test
