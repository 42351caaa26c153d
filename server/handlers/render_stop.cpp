// Head comment in render_stop.h.
#include "server/handlers/render_stop.h"

namespace sunfleck {

RenderStop::RenderStop(ServerState& state, const std::stop_token& call)
    : state_(state),
      ticket_(state.renders, source_),
      with_call_(call, [source = source_]() mutable { source.request_stop(); }) {}

RenderStop::~RenderStop() {
  if (watched_) state_.watch.remove(*watched_);
}

// The watch may call back after this is gone: it holds what it needs.
void RenderStop::after(double seconds) {
  using Clock = DeadlineWatch::Clock;
  const auto wait = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  watched_ = state_.watch.add(Clock::now() + wait, [source = source_, is_up = time_is_up_]() mutable {
    is_up->store(true);
    source.request_stop();
  });
}

}  // namespace sunfleck
