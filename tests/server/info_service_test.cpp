// What a server tells of itself, and what standard tools ask it: health and reflection. Their messages are so
// small that the tests speak them byte by byte.
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <future>

#include "server/convert/light_spec_message.h"
#include "sim/base/version.h"
#include "sunfleck/v1/light.grpc.pb.h"
#include "tests/server/served.h"

namespace sunfleck::test {
namespace {

std::string bytes_of(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  EXPECT_TRUE(buffer.Dump(&slices).ok());
  std::string bytes;
  for (const grpc::Slice& s : slices) bytes.append(reinterpret_cast<const char*>(s.begin()), s.size());
  return bytes;
}

// One message there, one back; over a stream or not is the same on the wire.
std::string ask(const ServedProcess& server, const std::string& method, const std::string& bytes) {
  grpc::GenericStub stub(server.channel());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  const grpc::Slice slice(bytes);
  const grpc::ByteBuffer request(&slice, 1);
  grpc::ByteBuffer response;
  std::promise<grpc::Status> done;
  stub.UnaryCall(&context, method, {}, &request, &response,
                 [&done](grpc::Status status) { done.set_value(std::move(status)); });
  const grpc::Status status = done.get_future().get();
  EXPECT_TRUE(status.ok()) << method << ": " << status.error_message();
  return bytes_of(response);
}

TEST(InfoService, TellsVersionMethodsSpeciesAndTheLimitsInForce) {
  ServedProcess server("queued_calls = 17\ntrees_per_spec = 1234\n");
  const ServerReport report = server.client().info();
  EXPECT_EQ(report.version, kVersion);
  EXPECT_EQ(report.methods, method_names());
  EXPECT_EQ(report.species.size(), species().all().size());
  const auto limit = [&](const std::string& name) {
    const auto found = std::find_if(report.limits.begin(), report.limits.end(),
                                    [&](const auto& field) { return field.first == name; });
    return found == report.limits.end() ? std::string("none") : found->second;
  };
  EXPECT_EQ(limit("queued_calls"), "17");
  EXPECT_EQ(limit("trees_per_spec"), "1234");
  EXPECT_EQ(limit("message_bytes"), std::to_string(4 << 20));
}

TEST(InfoService, HealthSaysServing) {
  ServedProcess server;
  // HealthCheckResponse{status = 1: SERVING}: field 1, varint 1.
  EXPECT_EQ(ask(server, "/grpc.health.v1.Health/Check", ""), std::string("\x08\x01", 2));
}

TEST(InfoService, ReflectionListsAllServices) {
  ServedProcess server;
  // ServerReflectionRequest{list_services = "*"}: field 7, length 1.
  const std::string answer = ask(server, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
                                 std::string("\x3a\x01*", 3));
  for (const char* service :
       {"sunfleck.v1.SceneService", "sunfleck.v1.LightService", "sunfleck.v1.RenderService",
        "sunfleck.v1.ServerInfoService", "grpc.health.v1.Health"}) {
    EXPECT_NE(answer.find(service), std::string::npos) << service;
  }
}

TEST(InfoService, SocketIsItsOwnersOnly) {
  ServedProcess server;
  struct stat facts {};
  ASSERT_EQ(::stat(server.socket().c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0600u);
}

TEST(QueryLight, AnswersAreThoseOfTheWholeMap) {
  ServedProcess server;
  Client client = server.client();
  const std::string scene = client.create_scene(row_of_trees(3, 200)).name;
  const LightMap map = client.light_map(scene, noon(Method::kReference));
  v1::QueryLightRequest request;
  request.set_scene(scene);
  fill_message(noon(Method::kReference), *request.mutable_light());
  request.add_element_ranges()->set_first(350);
  request.mutable_element_ranges(0)->set_count(40);
  request.add_element_ranges()->set_count(3);
  request.add_id_trees(11);
  grpc::ClientContext context;
  v1::QueryLightResponse answer;
  const grpc::Status status =
      v1::LightService::NewStub(server.channel())->QueryLight(&context, request, &answer);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(answer.bands_size(), 2);
  ASSERT_EQ(answer.bands(1).elements().absorbed_w_size(), 43);
  EXPECT_EQ(answer.bands(1).elements().absorbed_w(5), map.bands[1].elements[355].absorbed_w);
  EXPECT_EQ(answer.bands(1).elements().back_sky_w_m2(41), map.bands[1].elements[1].back.sky_w_m2);
  EXPECT_EQ(answer.bands(1).elements().standard_error_w_m2(0), map.bands[1].standard_error_w_m2[350]);
  EXPECT_EQ(answer.sunlit_fraction(42), map.sunlit_fraction[2]);
  ASSERT_EQ(answer.bands(0).trees_size(), 1);
  EXPECT_EQ(answer.bands(0).trees(0).absorbed_w(), map.bands[0].trees[1].absorbed_w);
  EXPECT_EQ(answer.provenance().method(), "reference");
  EXPECT_EQ(answer.provenance().forest_hash(), map.provenance.forest_hash);
}

}  // namespace
}  // namespace sunfleck::test
