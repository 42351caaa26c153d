// How the client reads a stream to its end. For server/client only.
#pragma once

#include <grpcpp/grpcpp.h>

#include "server/client/client_state.h"
#include "sim/base/error.h"

namespace sunfleck {

inline void report(const v1::Progress& progress, const RunControl& control) {
  control.report(progress.stage(), progress.fraction());
}

// With `use`. A failure in `use` cancels the call, a bad end throws what it says.
template <class Response, class Use>
void read_all(WatchedCall& call, grpc::ClientReader<Response>& reader, const Use& use) {
  Response message;
  try {
    while (reader.Read(&message)) use(message);
  } catch (...) {
    call.context().TryCancel();
    while (reader.Read(&message)) continue;
    reader.Finish();
    throw;
  }
  throw_unless_ok(reader.Finish());
}

[[noreturn]] inline void throw_incomplete() {
  throw Error(ErrorKind::kInputOutput, "the answer", "ended without its summary", "ask again");
}

}  // namespace sunfleck
