// A slow stream of a served light map that has begun, for tests that end it.
#pragma once

#include <grpcpp/grpcpp.h>

#include "server/convert/light_spec_message.h"
#include "sunfleck/v1/light.grpc.pb.h"
#include "tests/server/served.h"

namespace sunfleck::test {

inline v1::StreamLightMapRequest slow_message(const std::string& scene) {
  v1::StreamLightMapRequest message;
  message.set_scene(scene);
  fill_message(slow_request(), *message.mutable_light());
  return message;
}

// A slow stream whose header has arrived: it runs on a worker.
struct RunningStream {
  RunningStream(const ServedProcess& server, const std::string& scene)
      : stub(v1::LightService::NewStub(server.channel())),
        reader(stub->StreamLightMap(&context, slow_message(scene))) {}
  bool wait_for_header() {
    v1::StreamLightMapResponse part;
    return reader->Read(&part) && part.has_header();
  }
  grpc::Status drain() {
    v1::StreamLightMapResponse part;
    while (reader->Read(&part)) continue;
    return reader->Finish();
  }
  grpc::ClientContext context;
  std::unique_ptr<v1::LightService::Stub> stub;
  std::unique_ptr<grpc::ClientReader<v1::StreamLightMapResponse>> reader;
};

// 20,000 elements.
inline std::string big_scene(Client& client) { return client.create_scene(row_of_trees(4, 5000)).name; }

}  // namespace sunfleck::test
