// One question, a stream of answers: the pool computes and pushes a few messages ahead, then the rest is
// pulled as fast as the reader takes it. At most one write is under way.
#pragma once

#include <grpcpp/support/server_callback.h>
#include <spdlog/spdlog.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <optional>
#include <utility>

#include "server/handlers/failures.h"
#include "sim/base/error.h"

namespace sunfleck {

// `Response` has a oneof with a member `progress`.
template <class Response>
class StreamCall final : public grpc::ServerWriteReactor<Response> {
 public:
  // Fills the next message; false when there is none left. Called from one thread at a time, after the work.
  using Next = std::function<bool(Response& message)>;
  // Runs on a worker; may push; returns what is still to be sent.
  using Work = std::function<Next(StreamCall& call, const RunControl& control)>;

  static grpc::ServerWriteReactor<Response>* start(ServerState& state, grpc::CallbackServerContext& context,
                                                   const char* method, Work work);
  StreamCall(ServerState& state, grpc::CallbackServerContext& context, const char* method)
      : control_(std::make_shared<CallControl>(state, context, method)) {}

  // For the worker: waits while kAhead messages wait for the reader; throws Error(kCancelled) once stopped.
  void push(Response message);

  void OnWriteDone(bool ok) override;
  void OnCancel() override { control_->stop(StopReason::kClient); }
  void OnDone() override {
    control_->close();
    const std::shared_ptr<StreamCall> last = std::move(self_);
  }

 private:
  static constexpr std::size_t kAhead = 4;
  static constexpr double kProgressEvery_s = 0.26;  // at most four a second

  void run(const Work& work) noexcept;
  void end(grpc::Status status);
  void offer_progress(std::string_view stage, double fraction);
  void pump();                        // begins the next write, or finishes, unless a write is under way
  bool take_next(Response& message);  // false: nothing to send now

  const std::shared_ptr<CallControl> control_;
  std::shared_ptr<StreamCall> self_;
  std::mutex mutex_;
  std::condition_variable_any room_;
  std::deque<Response> waiting_;
  std::optional<grpc::Status> end_;  // set when the work is over
  Next rest_;
  Response current_;  // belongs to who has set busy_
  bool busy_ = false, finished_ = false;
  double last_progress_s_ = -kProgressEvery_s;
};

template <class Response>
grpc::ServerWriteReactor<Response>* StreamCall<Response>::start(ServerState& state,
                                                                grpc::CallbackServerContext& context,
                                                                const char* method, Work work) {
  const auto call = std::make_shared<StreamCall>(state, context, method);
  call->self_ = call;
  call->control_->watch_deadline(CallLength::kStream);
  const bool accepted =
      !state.draining && state.pool.try_submit({
                             [call, work = std::move(work)] { call->run(work); },
                             [call] { call->end(status_of_stop(call->control_->reason())); },
                             call->control_->token(),
                         });
  if (!accepted) call->end(status_of_refusal(state));
  return call.get();
}

template <class Response>
void StreamCall<Response>::run(const Work& work) noexcept {
  try {
    const RunControl control{control_->token(), [this](std::string_view stage, double fraction) {
                               offer_progress(stage, fraction);
                             }};
    Next rest = work(*this, control);
    {
      const std::lock_guard lock(mutex_);
      rest_ = std::move(rest);
    }
    end(grpc::Status::OK);
  } catch (...) {
    end(status_of_exception(control_->state(), control_->method(), control_->reason()));
  }
}

template <class Response>
void StreamCall<Response>::end(grpc::Status status) {
  {
    const std::lock_guard lock(mutex_);
    if (!status.ok()) waiting_.clear();
    end_ = std::move(status);
  }
  pump();
}

template <class Response>
void StreamCall<Response>::push(Response message) {
  {
    std::unique_lock lock(mutex_);
    const bool has_room = room_.wait(lock, control_->token(), [this] { return waiting_.size() < kAhead; });
    if (!has_room || control_->token().stop_requested()) throw_cancelled();
    waiting_.push_back(std::move(message));
  }
  pump();
}

template <class Response>
void StreamCall<Response>::offer_progress(std::string_view stage, double fraction) {
  const double now_s = control_->elapsed_s();
  {
    const std::lock_guard lock(mutex_);
    if (busy_ || !waiting_.empty() || now_s - last_progress_s_ < kProgressEvery_s) return;
    last_progress_s_ = now_s;
    Response& message = waiting_.emplace_back();
    message.mutable_progress()->set_stage(std::string(stage));
    message.mutable_progress()->set_fraction(fraction);
    message.mutable_progress()->set_elapsed_s(now_s);
  }
  pump();
}

template <class Response>
bool StreamCall<Response>::take_next(Response& message) {
  Next rest;
  {
    const std::lock_guard lock(mutex_);
    if (!waiting_.empty()) {
      message = std::move(waiting_.front());
      waiting_.pop_front();
      room_.notify_one();
      return true;
    }
    if (!end_ || !end_->ok() || !rest_ || control_->token().stop_requested()) return false;
    rest = std::exchange(rest_, nullptr);
  }
  message.Clear();
  const bool more = rest(message);
  const std::lock_guard lock(mutex_);
  if (more) rest_ = std::move(rest);
  return more;
}

template <class Response>
void StreamCall<Response>::pump() {
  {
    const std::lock_guard lock(mutex_);
    if (busy_ || finished_) return;
    busy_ = true;
  }
  if (take_next(current_)) {
    control_->write_begins();
    this->StartWrite(&current_);
    return;
  }
  std::optional<grpc::Status> last;
  bool again = false;
  {
    const std::lock_guard lock(mutex_);
    busy_ = false;
    const bool has_rest = end_ && end_->ok() && rest_ && !control_->token().stop_requested();
    again = !waiting_.empty() || has_rest;  // came since take_next looked
    if (!again && end_) {
      finished_ = true;
      last = control_->token().stop_requested() ? status_of_stop(control_->reason()) : *end_;
      if (!end_->ok()) last = *end_;
    }
  }
  if (again) return pump();
  if (!last) return;
  control_->state().log->info("method={} code={} elapsed_s={:.4f}", control_->method(),
                              static_cast<int>(last->error_code()), control_->elapsed_s());
  this->Finish(*last);
}

template <class Response>
void StreamCall<Response>::OnWriteDone(bool ok) {
  control_->write_ends();
  if (!ok) control_->stop(StopReason::kClient);
  {
    const std::lock_guard lock(mutex_);
    busy_ = false;
    if (!ok) waiting_.clear();
  }
  room_.notify_one();
  pump();
}

}  // namespace sunfleck
