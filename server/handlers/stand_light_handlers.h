// StandLightService.
#pragma once

#include "server/jobs/server_state.h"
#include "sunfleck/v1/stand_light.grpc.pb.h"

namespace sunfleck {

class StandLightHandlers final : public v1::StandLightService::CallbackService {
 public:
  explicit StandLightHandlers(ServerState& state) : state_(state) {}

  grpc::ServerWriteReactor<v1::StreamStandLightResponse>* StreamStandLight(
      grpc::CallbackServerContext* context, const v1::StreamStandLightRequest* request) override;
  grpc::ServerUnaryReactor* EstimateStandLight(grpc::CallbackServerContext* context,
                                               const v1::StreamStandLightRequest* request,
                                               v1::StandLightCost* response) override;

 private:
  ServerState& state_;
};

}  // namespace sunfleck
