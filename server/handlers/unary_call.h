// One question, one answer: computed by the pool, or given at once where it costs nothing.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <functional>

#include "server/handlers/call_control.h"

namespace sunfleck {

// Fills the response of the call, or throws.
using UnaryWork = std::function<void(const RunControl& control)>;

// Runs `work` on the pool. The response must be the one gRPC handed to the handler: it lives until the call
// is over.
grpc::ServerUnaryReactor* compute_unary(ServerState& state, grpc::CallbackServerContext& context,
                                        const char* method, UnaryWork work);

// Runs `work`, which must be a look-up of microseconds, on the callback's own thread.
grpc::ServerUnaryReactor* answer_at_once(ServerState& state, grpc::CallbackServerContext& context,
                                         const char* method, const std::function<void()>& work);

}  // namespace sunfleck
