// ServerInfoService.
#pragma once

#include "server/jobs/server_state.h"
#include "sunfleck/v1/server_info.grpc.pb.h"

namespace sunfleck {

class InfoHandlers final : public v1::ServerInfoService::CallbackService {
 public:
  explicit InfoHandlers(ServerState& state) : state_(state) {}

  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest* request,
                                          v1::ServerInfo* response) override;

 private:
  ServerState& state_;
};

}  // namespace sunfleck
