// RenderService.
#pragma once

#include <filesystem>

#include "server/jobs/server_state.h"
#include "sunfleck/v1/render.grpc.pb.h"

namespace sunfleck {

class RenderHandlers final : public v1::RenderService::CallbackService {
 public:
  // `scratch`: an existing private folder for image files on their way.
  RenderHandlers(ServerState& state, std::filesystem::path scratch)
      : state_(state), scratch_(std::move(scratch)) {}

  grpc::ServerWriteReactor<v1::StreamRenderResponse>* StreamRender(
      grpc::CallbackServerContext* context, const v1::StreamRenderRequest* request) override;
  grpc::ServerUnaryReactor* StopRender(grpc::CallbackServerContext* context,
                                       const v1::StopRenderRequest* request,
                                       v1::StopRenderResponse* response) override;

 private:
  ServerState& state_;
  const std::filesystem::path scratch_;
};

}  // namespace sunfleck
