// LightService.
#pragma once

#include "server/jobs/server_state.h"
#include "sunfleck/v1/light.grpc.pb.h"

namespace sunfleck {

class LightHandlers final : public v1::LightService::CallbackService {
 public:
  explicit LightHandlers(ServerState& state) : state_(state) {}

  grpc::ServerUnaryReactor* QueryLight(grpc::CallbackServerContext* context,
                                       const v1::QueryLightRequest* request,
                                       v1::QueryLightResponse* response) override;
  grpc::ServerWriteReactor<v1::StreamLightMapResponse>* StreamLightMap(
      grpc::CallbackServerContext* context, const v1::StreamLightMapRequest* request) override;

 private:
  ServerState& state_;
};

}  // namespace sunfleck
