// What ends a stand light request before its time: the client, its deadline, a full pool.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "server/convert/stand_request.h"
#include "sim/base/error.h"
#include "sunfleck/v1/stand_light.grpc.pb.h"
#include "tests/server/stand_scene.h"

namespace sunfleck::test {
namespace {

#ifdef SUNFLECK_UNSANITIZED
constexpr double kStopWithin_s = 0.100;
#else
constexpr double kStopWithin_s = 2.0;  // a sanitizer's build is many times slower
#endif

// A request of minutes whose header has arrived: it runs on a worker.
struct Running {
  Running(const ServedProcess& server, const std::string& scene, double deadline_s = 0)
      : stub(v1::StandLightService::NewStub(server.channel())) {
    v1::StreamStandLightRequest request;
    request.set_scene(scene);
    fill_message(slow_study(), *request.mutable_stand_light());
    if (deadline_s > 0)
      context.set_deadline(std::chrono::system_clock::now() +
                           std::chrono::milliseconds(static_cast<int>(1e3 * deadline_s)));
    reader = stub->StreamStandLight(&context, request);
  }
  bool wait_for_header() {
    v1::StreamStandLightResponse part;
    return reader->Read(&part) && part.has_header();
  }
  grpc::Status drain() {
    v1::StreamStandLightResponse part;
    while (reader->Read(&part)) continue;
    return reader->Finish();
  }
  grpc::ClientContext context;
  std::unique_ptr<v1::StandLightService::Stub> stub;
  std::unique_ptr<grpc::ClientReader<v1::StreamStandLightResponse>> reader;
};

TEST(StandStop, CancelFreesTheWorkerWithin100ms) {
  ServedProcess server("running_calls = 1\n");
  Client client = server.client();
  const std::string scene = client.create_scene(tiny_stand()).name;
  std::vector<double> freed_s;
  for (int i = 0; i < 10; ++i) {
    Running call(server, scene);
    ASSERT_TRUE(call.wait_for_header());
    std::this_thread::sleep_for(std::chrono::milliseconds(20 * i));  // different moments
    ASSERT_EQ(load_of(client, "running_calls"), 1u);
    const auto cancelled = std::chrono::steady_clock::now();
    call.context.TryCancel();
    ASSERT_GE(wait_for_load(client, "running_calls", 0, 30), 0.0);
    freed_s.push_back(seconds_since(cancelled));
    EXPECT_EQ(call.drain().error_code(), grpc::StatusCode::CANCELLED);
  }
  std::sort(freed_s.begin(), freed_s.end());
  std::printf("worker free after a cancel: median %.1f ms, worst of 10 %.1f ms\n", freed_s[5] * 1e3,
              freed_s.back() * 1e3);
  EXPECT_LE(freed_s[5], kStopWithin_s);
  EXPECT_NO_THROW(client.stand_light(scene, tiny_study()));
}

TEST(StandStop, DeadlineFreesTheWorker) {
  ServedProcess server("running_calls = 1\n");
  Client client = server.client();
  const std::string scene = client.create_scene(tiny_stand()).name;
  Running call(server, scene, 0.5);
  EXPECT_EQ(call.drain().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  const double freed_s = wait_for_load(client, "running_calls", 0, 30);
  EXPECT_GE(freed_s, 0.0);
  std::printf("worker free %.1f ms after the deadline\n", freed_s * 1e3);
  EXPECT_LE(freed_s, kStopWithin_s);
}

TEST(StandStop, ServersOwnDeadlineIsToldInTheAnswer) {
  ServedProcess server("longest_deadline_s = 0.2\ndefault_deadline_s = 0.2\n");
  Client client = server.client();
  Running call(server, client.create_scene(tiny_stand()).name);  // states no deadline
  const grpc::Status status = call.drain();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED) << status.error_message();
  EXPECT_NE(status.error_message().find("deadline"), std::string::npos) << status.error_message();
}

TEST(StandStop, StopTokenOfTheClientLibraryCancels) {
  ServedProcess server("running_calls = 1\n");
  Client client = server.client();
  const std::string scene = client.create_scene(tiny_stand()).name;
  std::stop_source stop;
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop.request_stop();
  });
  try {
    client.stand_light(scene, slow_study(), {stop.get_token(), {}});
    ADD_FAILURE() << "the call was not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled) << error.what();
  }
  EXPECT_GE(wait_for_load(client, "running_calls", 0, 5), 0.0);
}

TEST(StandStop, FullPoolRefusesAtOnce) {
  ServedProcess server("running_calls = 1\nqueued_calls = 1\n");
  Client client = server.client();
  const std::string scene = client.create_scene(tiny_stand()).name;
  Running running(server, scene);
  ASSERT_TRUE(running.wait_for_header());
  Running queued(server, scene);
  ASSERT_GE(wait_for_load(client, "queued_calls", 1, 5), 0.0);
  Running refused(server, scene);
  EXPECT_EQ(refused.drain().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  queued.context.TryCancel();
  running.context.TryCancel();
  EXPECT_GE(wait_for_load(client, "running_calls", 0, 5), 0.0);
}

}  // namespace
}  // namespace sunfleck::test
