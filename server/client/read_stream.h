// How the client reads a stream to its end. For server/client only.
#pragma once

#include <grpcpp/grpcpp.h>

#include <optional>
#include <type_traits>
#include <utility>

#include "server/client/client_state.h"
#include "server/convert/array_message.h"
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

// A stream of progress, arrays and one summary, which is returned.
template <class Response>
auto read_arrays(WatchedCall& call, grpc::ClientReader<Response>& reader, const RunControl& control,
                 ArrayAssembler& arrays) {
  std::optional<std::remove_cvref_t<decltype(std::declval<Response>().summary())>> summary;
  read_all(call, reader, [&](Response& part) {
    if (part.has_progress()) report(part.progress(), control);
    if (part.has_array()) arrays.begin(part.array());
    if (part.has_chunk()) arrays.add(part.chunk());
    if (part.has_summary()) summary = std::move(*part.mutable_summary());
  });
  if (!summary) throw_incomplete();
  return *std::move(summary);
}

}  // namespace sunfleck
