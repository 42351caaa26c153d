// The end of every stream of arrays: each array announced, then its chunks, then one last message, then
// nothing.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "server/handlers/array_source.h"
#include "server/handlers/stream_call.h"

namespace sunfleck {

// `owner` keeps the bytes behind the views; `announce`: the member of the response that announces an array.
template <class Response>
typename StreamCall<Response>::Next arrays_then(std::shared_ptr<const void> owner,
                                                std::vector<ArrayView> views,
                                                v1::ArrayHeader* (Response::*announce)(),
                                                std::function<void(Response&)> fill_last) {
  return [owner = std::move(owner), source = ArraySource(std::move(views)), announce,
          fill_last = std::move(fill_last), last_sent = false](Response& message) mutable {
    switch (source.next()) {
      case ArraySource::Part::kHeader:
        source.fill(*(message.*announce)());
        return true;
      case ArraySource::Part::kChunk:
        source.fill(*message.mutable_chunk());
        return true;
      case ArraySource::Part::kEnd:
        break;
    }
    if (std::exchange(last_sent, true)) return false;
    fill_last(message);
    return true;
  };
}

}  // namespace sunfleck
