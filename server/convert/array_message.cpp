// Head comment in array_message.h. Little-endian like every processor this builds for.
#include "server/convert/array_message.h"

#include <algorithm>
#include <bit>

#include "server/convert/crc32c.h"
#include "sim/base/error.h"
#include "sunfleck/v1/common.pb.h"

namespace sunfleck {
namespace {

static_assert(std::endian::native == std::endian::little);

v1::DataType message_type(ElementType type) {
  switch (type) {
    case ElementType::kUint8:
      return v1::DATA_TYPE_UINT8;
    case ElementType::kUint32:
      return v1::DATA_TYPE_UINT32;
    case ElementType::kFloat16:
      return v1::DATA_TYPE_FLOAT16;
    case ElementType::kFloat32:
      return v1::DATA_TYPE_FLOAT32;
    case ElementType::kFloat64:
      return v1::DATA_TYPE_FLOAT64;
  }
  return v1::DATA_TYPE_UNSPECIFIED;
}

[[noreturn]] void refuse(const std::string& array, const std::string& problem) {
  throw Error(ErrorKind::kInputOutput, "array '" + array + "'", problem,
              "the stream is damaged or of another version; ask again");
}

ElementType type_from_message(const v1::ArrayHeader& header) {
  switch (header.data_type()) {
    case v1::DATA_TYPE_UINT8:
      return ElementType::kUint8;
    case v1::DATA_TYPE_UINT32:
      return ElementType::kUint32;
    case v1::DATA_TYPE_FLOAT16:
      return ElementType::kFloat16;
    case v1::DATA_TYPE_FLOAT32:
      return ElementType::kFloat32;
    case v1::DATA_TYPE_FLOAT64:
      return ElementType::kFloat64;
    default:
      refuse(header.name(), "unknown data type " + std::to_string(header.data_type()));
  }
}

}  // namespace

std::size_t chunk_count(const ArrayView& array) {
  return (array.bytes.size() + kChunkBytes - 1) / kChunkBytes;
}

void fill_header(const ArrayView& array, std::uint32_t index, v1::ArrayHeader& message) {
  message.set_array_index(index);
  message.set_name(array.name);
  message.set_data_type(message_type(array.type));
  for (const std::uint64_t n : array.shape) message.add_shape(n);
  for (const std::string& column : array.columns) message.add_columns(column);
  message.set_size_bytes(array.bytes.size());
}

void fill_chunk(const ArrayView& array, std::uint32_t index, std::size_t chunk, v1::ArrayChunk& message) {
  const std::size_t offset = chunk * kChunkBytes;
  const auto bytes = array.bytes.subspan(offset, std::min(kChunkBytes, array.bytes.size() - offset));
  message.set_array_index(index);
  message.set_offset_bytes(offset);
  message.set_data(bytes.data(), bytes.size());
  message.set_crc32c(crc32c(bytes));
}

void ArrayAssembler::begin(const v1::ArrayHeader& header) {
  constexpr std::uint64_t kMostBytes = 1ull << 40;
  if (header.array_index() != arrays_.size()) refuse(header.name(), "announced out of order");
  if (header.size_bytes() > kMostBytes) refuse(header.name(), "announced with an impossible size");
  ReceivedArray array{header.name(), type_from_message(header), {}, {}, {}};
  array.columns.assign(header.columns().begin(), header.columns().end());
  array.shape.assign(header.shape().begin(), header.shape().end());
  arrays_.push_back(std::move(array));
  sizes_.push_back(header.size_bytes());
}

void ArrayAssembler::add(const v1::ArrayChunk& chunk) {
  if (chunk.array_index() + 1 != arrays_.size()) refuse("?", "chunk of an array that was not announced");
  ReceivedArray& array = arrays_.back();
  if (chunk.offset_bytes() != array.bytes.size()) refuse(array.name, "chunk out of order");
  if (array.bytes.size() + chunk.data().size() > sizes_.back()) refuse(array.name, "longer than announced");
  if (crc32c(chunk.data()) != chunk.crc32c()) refuse(array.name, "wrong checksum of a chunk");
  if (array.bytes.empty()) array.bytes.reserve(std::min<std::uint64_t>(sizes_.back(), 1ull << 28));
  array.bytes.append(chunk.data());
  received_bytes_ += chunk.data().size();
}

std::vector<ReceivedArray> ArrayAssembler::finish() {
  for (std::size_t i = 0; i < arrays_.size(); ++i) {
    if (arrays_[i].bytes.size() != sizes_[i]) refuse(arrays_[i].name, "incomplete");
  }
  return std::move(arrays_);
}

}  // namespace sunfleck
