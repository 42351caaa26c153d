// Walks arrays in the order of the wire: header, chunks, next header, ...
#pragma once

#include <cstdint>
#include <vector>

#include "server/convert/array_message.h"

namespace sunfleck {

class ArraySource {
 public:
  enum class Part { kHeader, kChunk, kEnd };
  // The bytes behind the views must outlive this.
  explicit ArraySource(std::vector<ArrayView> views) : views_(std::move(views)) {}

  // Steps on; fill() then writes that part.
  Part next();
  void fill(v1::ArrayHeader& message) const { fill_header(views_[array_], index(), message); }
  void fill(v1::ArrayChunk& message) const { fill_chunk(views_[array_], index(), chunk_, message); }

 private:
  std::uint32_t index() const { return static_cast<std::uint32_t>(array_); }

  std::vector<ArrayView> views_;
  std::size_t array_ = 0, chunk_ = 0;
  bool announced_ = false, begun_ = false;
};

}  // namespace sunfleck
