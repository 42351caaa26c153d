// What the parts of the client share: the channel, the stubs, and how a call is watched. For server/client
// only.
#pragma once

#include <grpcpp/grpcpp.h>

#include <stop_token>

#include "server/client/client.h"
#include "server/convert/status_message.h"
#include "sunfleck/v1/light.grpc.pb.h"
#include "sunfleck/v1/render.grpc.pb.h"
#include "sunfleck/v1/scene.grpc.pb.h"
#include "sunfleck/v1/server_info.grpc.pb.h"
#include "sunfleck/v1/stand_light.grpc.pb.h"

namespace sunfleck {

struct Client::State {
  explicit State(const ConnectOptions& given);
  const ConnectOptions options;
  const std::shared_ptr<grpc::Channel> channel;
  const std::unique_ptr<v1::SceneService::Stub> scenes;
  const std::unique_ptr<v1::LightService::Stub> light;
  const std::unique_ptr<v1::StandLightService::Stub> stand_light;
  const std::unique_ptr<v1::RenderService::Stub> render;
  const std::unique_ptr<v1::ServerInfoService::Stub> info;
};

// A client context with the deadline of the options, cancelled by a stop of the control.
class WatchedCall {
 public:
  WatchedCall(const ConnectOptions& options, const RunControl& control);
  grpc::ClientContext& context() { return context_; }

 private:
  grpc::ClientContext context_;
  std::stop_callback<std::function<void()>> on_stop_;
};

// Throws what a status says, unless it is OK.
void throw_unless_ok(const grpc::Status& status);

}  // namespace sunfleck
