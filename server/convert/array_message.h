// Arrays on the wire: announced by a header, sent as chunks of at most 256 KiB that each carry a CRC-32C.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sunfleck {

namespace v1 {
class ArrayHeader;
class ArrayChunk;
}  // namespace v1

inline constexpr std::size_t kChunkBytes = 256 * 1024;

enum class ElementType { kUint8, kUint32, kFloat16, kFloat32, kFloat64 };

// Bytes that stay where they are while they are sent.
struct ArrayView {
  std::string name;
  ElementType type = ElementType::kUint8;
  std::vector<std::uint64_t> shape;
  std::vector<std::string> columns;
  std::span<const std::byte> bytes;
};

std::size_t chunk_count(const ArrayView& array);
void fill_header(const ArrayView& array, std::uint32_t index, v1::ArrayHeader& message);
void fill_chunk(const ArrayView& array, std::uint32_t index, std::size_t chunk, v1::ArrayChunk& message);

// An array as it arrives.
struct ReceivedArray {
  std::string name;
  ElementType type = ElementType::kUint8;
  std::vector<std::uint64_t> shape;
  std::vector<std::string> columns;
  std::string bytes;
};

// Puts the chunks of a stream together. Throws Error(kInputOutput) for a wrong checksum, order, size or type.
class ArrayAssembler {
 public:
  void begin(const v1::ArrayHeader& header);
  void add(const v1::ArrayChunk& chunk);
  std::vector<ReceivedArray> finish();  // throws if one is incomplete
  std::uint64_t received_bytes() const { return received_bytes_; }

 private:
  std::vector<ReceivedArray> arrays_;
  std::vector<std::uint64_t> sizes_;
  std::uint64_t received_bytes_ = 0;
};

}  // namespace sunfleck
