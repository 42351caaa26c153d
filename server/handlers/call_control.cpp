// Head comment in call_control.h.
#include "server/handlers/call_control.h"

#include <algorithm>

namespace sunfleck {
namespace {

using Clock = DeadlineWatch::Clock;

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

constexpr double kNever_s = 1e6;

}  // namespace

CallControl::CallControl(ServerState& state, grpc::CallbackServerContext& context, const char* method)
    : state_(state), context_(&context), method_(method) {
  ++state_.live_calls;
}

void CallControl::watch_deadline(CallLength length) {
  const Limits& limits = state_.limits;
  double allowed_s = length == CallLength::kUnary ? limits.default_deadline_s : limits.longest_deadline_s;
  const auto stated = context_->deadline();
  if (stated != std::chrono::system_clock::time_point::max()) {
    const std::chrono::duration<double> left = stated - std::chrono::system_clock::now();
    allowed_s = std::clamp(left.count(), 0.0, limits.longest_deadline_s);
  }
  deadline_ = state_.watch.add(after(allowed_s), [weak = weak_from_this()] {
    if (const auto call = weak.lock()) call->stop(StopReason::kDeadline);
  });
  on_ending_.emplace(state_.ending.get_token(), [weak = weak_from_this()] {
    if (const auto call = weak.lock()) call->stop(StopReason::kDrain);
  });
}

void CallControl::write_begins() {
  const Clock::time_point stalled_at = after(state_.limits.stalled_write_s);
  if (stall_ != 0) return state_.watch.move(stall_, stalled_at);
  stall_ = state_.watch.add(stalled_at, [weak = weak_from_this()] {
    if (const auto call = weak.lock()) call->stop_and_break(StopReason::kStalled);
  });
}

void CallControl::write_ends() { state_.watch.move(stall_, after(kNever_s)); }

void CallControl::stop(StopReason reason) {
  StopReason none = StopReason::kNone;
  reason_.compare_exchange_strong(none, reason);
  source_.request_stop();
  state_.pool.discard_stopped();
}

void CallControl::stop_and_break(StopReason reason) {
  stop(reason);
  const std::lock_guard lock(context_mutex_);
  if (context_) context_->TryCancel();
}

void CallControl::close() {
  state_.watch.remove(deadline_);
  state_.watch.remove(stall_);
  {
    const std::lock_guard lock(context_mutex_);
    context_ = nullptr;
  }
  --state_.live_calls;
}

double CallControl::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

}  // namespace sunfleck
