// Every way a call can fail, told to the client in one form.
#pragma once

#include <grpcpp/support/status.h>

#include "server/handlers/call_control.h"
#include "server/jobs/server_state.h"

namespace sunfleck {

// Call inside a catch block. Mistakes of the client are explained; what is ours is logged under an incident
// id and the client gets only that id: never a path, an address or an exception's text.
grpc::Status status_of_exception(ServerState& state, const char* method, StopReason stopped);

grpc::Status status_of_stop(StopReason reason);
grpc::Status status_of_refusal(const ServerState& state);  // the pool is full, or the server drains

}  // namespace sunfleck
