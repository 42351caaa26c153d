// One running call: what may stop it, and why it was stopped.
#pragma once

#include <grpcpp/server_context.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>

#include "server/jobs/server_state.h"

namespace sunfleck {

enum class StopReason { kNone, kClient, kDeadline, kStalled, kDrain };

// Whether a call that states no deadline is a short answer or a long stream.
enum class CallLength { kUnary, kStream };

// Owned by shared_ptr: watch callbacks hold it weakly. Safe from all threads.
class CallControl : public std::enable_shared_from_this<CallControl> {
 public:
  CallControl(ServerState& state, grpc::CallbackServerContext& context, const char* method);

  void watch_deadline(CallLength length);  // and the end of the server
  // A write has begun (or ended): a reader that takes nothing for too long stops the call.
  void write_begins();
  void write_ends();
  void stop(StopReason reason);  // the first reason is kept
  void close();                  // gRPC has forgotten the call: the context is not touched any more

  // Stopped because the server has had enough of it: also breaks a write that hangs.
  void stop_and_break(StopReason reason);

  std::stop_token token() const { return source_.get_token(); }
  StopReason reason() const { return reason_; }
  const char* method() const { return method_; }
  ServerState& state() const { return state_; }
  double elapsed_s() const;

 private:
  ServerState& state_;
  grpc::CallbackServerContext* context_;  // null once closed
  const char* const method_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::stop_source source_;
  std::atomic<StopReason> reason_{StopReason::kNone};
  // Recursive: TryCancel may run the end of the call on this thread.
  std::recursive_mutex context_mutex_;
  DeadlineWatch::Id deadline_ = 0, stall_ = 0;
  std::optional<std::stop_callback<std::function<void()>>> on_ending_;
};

}  // namespace sunfleck
