// The head of a PLY file: which elements follow, and which values each of them has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sunfleck {

enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // of a list
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { kAscii, kBinaryLittleEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::size_t data_begin = 0;          // offset of the first byte after the head
  std::size_t lines = 0;               // of the head
  std::vector<std::string> materials;  // "comment material INDEX NAME", in order of their indexes from 0
};

PlyHeader parse_ply_header(std::string_view content, const std::string& file);

}  // namespace sunfleck
