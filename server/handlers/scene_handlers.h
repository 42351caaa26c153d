// SceneService.
#pragma once

#include "server/jobs/server_state.h"
#include "sunfleck/v1/scene.grpc.pb.h"

namespace sunfleck {

class SceneHandlers final : public v1::SceneService::CallbackService {
 public:
  explicit SceneHandlers(ServerState& state) : state_(state) {}

  grpc::ServerUnaryReactor* CreateScene(grpc::CallbackServerContext* context,
                                        const v1::CreateSceneRequest* request, v1::Scene* response) override;
  grpc::ServerUnaryReactor* GetScene(grpc::CallbackServerContext* context, const v1::GetSceneRequest* request,
                                     v1::Scene* response) override;
  grpc::ServerUnaryReactor* ListScenes(grpc::CallbackServerContext* context,
                                       const v1::ListScenesRequest* request,
                                       v1::ListScenesResponse* response) override;
  grpc::ServerUnaryReactor* DeleteScene(grpc::CallbackServerContext* context,
                                        const v1::DeleteSceneRequest* request,
                                        v1::DeleteSceneResponse* response) override;

 private:
  ServerState& state_;
};

}  // namespace sunfleck
