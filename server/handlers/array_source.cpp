// Head comment in array_source.h.
#include "server/handlers/array_source.h"

#include <utility>

namespace sunfleck {

ArraySource::Part ArraySource::next() {
  if (announced_) {
    chunk_ = std::exchange(begun_, true) ? chunk_ + 1 : 0;
    if (chunk_ < chunk_count(views_[array_])) return Part::kChunk;
    ++array_;
    announced_ = begun_ = false;
  }
  if (array_ >= views_.size()) return Part::kEnd;
  announced_ = true;
  return Part::kHeader;
}

}  // namespace sunfleck
