// Head comment in unary_call.h.
#include "server/handlers/unary_call.h"

#include <spdlog/spdlog.h>

#include "server/handlers/failures.h"

namespace sunfleck {
namespace {

// Lives until both gRPC (OnDone) and the pool have let go of it.
class UnaryCall final : public grpc::ServerUnaryReactor {
 public:
  UnaryCall(ServerState& state, grpc::CallbackServerContext& context, const char* method)
      : control_(std::make_shared<CallControl>(state, context, method)) {}

  void keep_alive(std::shared_ptr<UnaryCall> self) { self_ = std::move(self); }
  CallControl& control() { return *control_; }

  void run(const UnaryWork& work) noexcept {
    try {
      work({control_->token(), {}});
      end(grpc::Status::OK);
    } catch (...) {
      end(status_of_exception(control_->state(), control_->method(), control_->reason()));
    }
  }

  void end(const grpc::Status& status) {
    control_->state().log->info("method={} code={} elapsed_s={:.4f}", control_->method(),
                                static_cast<int>(status.error_code()), control_->elapsed_s());
    Finish(status);
  }

  void OnCancel() override { control_->stop(StopReason::kClient); }
  void OnDone() override {
    control_->close();
    const std::shared_ptr<UnaryCall> last = std::move(self_);
  }

 private:
  const std::shared_ptr<CallControl> control_;
  std::shared_ptr<UnaryCall> self_;
};

std::shared_ptr<UnaryCall> new_call(ServerState& state, grpc::CallbackServerContext& context,
                                    const char* method) {
  auto call = std::make_shared<UnaryCall>(state, context, method);
  call->keep_alive(call);
  return call;
}

}  // namespace

grpc::ServerUnaryReactor* compute_unary(ServerState& state, grpc::CallbackServerContext& context,
                                        const char* method, UnaryWork work) {
  const std::shared_ptr<UnaryCall> call = new_call(state, context, method);
  call->control().watch_deadline(CallLength::kUnary);
  const bool accepted =
      !state.draining && state.pool.try_submit({
                             [call, work = std::move(work)] { call->run(work); },
                             [call] { call->end(status_of_stop(call->control().reason())); },
                             call->control().token(),
                         });
  if (!accepted) call->end(status_of_refusal(state));
  return call.get();
}

grpc::ServerUnaryReactor* answer_at_once(ServerState& state, grpc::CallbackServerContext& context,
                                         const char* method, const std::function<void()>& work) {
  const std::shared_ptr<UnaryCall> call = new_call(state, context, method);
  if (state.draining) {
    call->end(status_of_refusal(state));
  } else {
    call->run([&work](const RunControl&) { work(); });
  }
  return call.get();
}

}  // namespace sunfleck
