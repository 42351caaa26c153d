// What may stop a render besides the end of its call: StopRender and the seconds it was given. Such a stop
// leaves the call alive, so that the picture of the samples taken so far can be sent.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>

#include "server/jobs/server_state.h"

namespace sunfleck {

class RenderStop {
 public:
  // `call`: a stop of the call stops the render too.
  RenderStop(ServerState& state, const std::stop_token& call);
  ~RenderStop();
  RenderStop(const RenderStop&) = delete;
  RenderStop& operator=(const RenderStop&) = delete;

  const std::string& name() const { return ticket_.name(); }  // for StopRender
  std::stop_token token() const { return source_.get_token(); }
  void after(double seconds);  // from now; once
  bool time_is_up() const { return time_is_up_->load(); }

 private:
  ServerState& state_;
  std::stop_source source_;
  RunningRenders::Ticket ticket_;
  std::stop_callback<std::function<void()>> with_call_;
  std::optional<DeadlineWatch::Id> watched_;
  std::shared_ptr<std::atomic<bool>> time_is_up_ = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace sunfleck
