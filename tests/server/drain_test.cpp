// SIGTERM: running calls finish within the grace period and no reply is lost, new ones are refused, exit code
// 0.
#include <gtest/gtest.h>
#include <signal.h>

#include <future>
#include <mutex>
#include <thread>

#include "sim/base/error.h"
#include "tests/server/running_stream.h"

namespace sunfleck::test {
namespace {

using Clock = std::chrono::steady_clock;

TEST(Drain, SigtermLetsTheRunningCallFinishAndExitsWith0) {
  ServedProcess server;
  Client client = server.client();
  const std::string scene = big_scene(client);
  LightRequest request = noon(Method::kReference);
  request.reference.rays_per_face = 64;
  request.reference.sun_rays_per_element = 128;
  std::promise<void> begun;
  const auto run = [&] {
    std::once_flag first;
    return server.client().light_map(scene, request, {{}, [&](std::string_view, double) {
                                                        std::call_once(first, [&] { begun.set_value(); });
                                                      }});
  };
  auto running = std::async(std::launch::async, run);
  begun.get_future().get();
  server.send_signal(SIGTERM);
  const LightMap map = running.get();  // throws if the call was lost
  EXPECT_EQ(map.bands.size(), 2u);
  const auto finished = Clock::now();
  EXPECT_EQ(server.wait_for_exit(10), 0);
  EXPECT_LE(seconds_since(finished), 2.0);  // the grace of 20 s is not waited for
  EXPECT_FALSE(std::filesystem::exists(server.socket()));
  EXPECT_NE(server.log().find("drained"), std::string::npos);
}

TEST(Drain, SigtermRefusesNewCallsWhileTheOldOneRuns) {
  ServedProcess server("running_calls = 2\ndrain_grace_s = 1\n");
  Client client = server.client();
  const std::string scene = big_scene(client);
  RunningStream running(server, scene);
  ASSERT_TRUE(running.wait_for_header());
  server.send_signal(SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  try {
    client.light_map(scene, noon(Method::kEnvelope));
    ADD_FAILURE() << "a draining server took a new call";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("shuts down"), std::string::npos) << error.what();
  }
  // The slow call outlives the grace period: it is stopped and told why, and the server still ends as it
  // should.
  const grpc::Status status = running.drain();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_NE(status.error_message().find("shuts down"), std::string::npos) << status.error_message();
  EXPECT_EQ(server.wait_for_exit(10), 0);
}

// Twenty times SIGTERM at other moments of a stream of 1.2 MB: no reply inside the grace period is lost.
TEST(Drain, TwentyDrainsLoseNoReply) {
  for (int i = 0; i < 20; ++i) {
    ServedProcess server;
    Client client = server.client();
    const std::string scene = big_scene(client);
    const LightRequest request = noon(i % 2 == 0 ? Method::kEnvelope : Method::kSpp);
    v1::StreamLightMapRequest message;
    message.set_scene(scene);
    fill_message(request, *message.mutable_light());
    const auto stub = v1::LightService::NewStub(server.channel());
    grpc::ClientContext context;
    auto reader = stub->StreamLightMap(&context, message);
    v1::StreamLightMapResponse part;
    for (int parts = 0; parts <= i % 5; ++parts) ASSERT_TRUE(reader->Read(&part));
    server.send_signal(SIGTERM);
    bool has_summary = false;
    while (reader->Read(&part)) has_summary = part.has_summary();
    const grpc::Status status = reader->Finish();
    EXPECT_TRUE(status.ok()) << i << ": " << status.error_message();
    EXPECT_TRUE(has_summary) << i;
    EXPECT_EQ(server.wait_for_exit(10), 0) << i;
  }
}

TEST(Drain, SigtermOfAnIdleServerIsQuick) {
  ServedProcess server;
  const auto start = Clock::now();
  server.send_signal(SIGTERM);
  EXPECT_EQ(server.wait_for_exit(10), 0);
  EXPECT_LE(seconds_since(start), 2.0);
}

}  // namespace
}  // namespace sunfleck::test
