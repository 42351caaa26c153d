#include "sim/plant/ply_header.h"

#include <map>

#include "sim/base/error.h"
#include "sim/plant/text_file.h"

namespace sunfleck {
namespace {

using Words = std::vector<std::string_view>;

PlyType parse_type(std::string_view name, const std::string& where) {
  static const std::map<std::string_view, PlyType> kTypes = {
      {"char", PlyType::kInt8},      {"int8", PlyType::kInt8},       {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},    {"short", PlyType::kInt16},     {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},  {"uint16", PlyType::kUint16},   {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},    {"uint", PlyType::kUint32},     {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},  {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end())
    throw_invalid(where, "unknown type \"" + std::string(name) + "\"",
                  "use char, uchar, short, ushort, int, uint, float or double");
  return found->second;
}

PlyFormat parse_format(const Words& words, const std::string& where) {
  if (words.size() == 3 && words[1] == "ascii") return PlyFormat::kAscii;
  if (words.size() == 3 && words[1] == "binary_little_endian") return PlyFormat::kBinaryLittleEndian;
  throw_invalid(where, "this PLY format is not read", "save as ascii or binary_little_endian 1.0");
}

PlyElement parse_element(const Words& words, const std::string& where) {
  if (words.size() != 3) throw_invalid(where, "is no element", "write \"element NAME COUNT\"");
  const std::int64_t count = parse_integer(words[2], where);
  if (count < 0) throw_invalid(where, "a count is negative", "write how many elements follow");
  return {std::string(words[1]), static_cast<std::size_t>(count), {}};
}

PlyProperty parse_property(const Words& words, const std::string& where) {
  if (words.size() == 3) return {std::string(words[2]), parse_type(words[1], where)};
  if (words.size() == 5 && words[1] == "list")
    return {std::string(words[4]), parse_type(words[3], where), true, parse_type(words[2], where)};
  throw_invalid(where, "is no property", "write \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
}

// Our own exports name the materials of their faces so; any other comment says nothing to us.
void add_comment(const Words& words, PlyHeader& header) {
  if (words.size() != 4 || words[1] != "material" || words[2] != std::to_string(header.materials.size()))
    return;
  header.materials.emplace_back(words[3]);
}

void add_statement(const Words& words, const std::string& where, PlyHeader& header) {
  if (words[0] == "format") {
    header.format = parse_format(words, where);
  } else if (words[0] == "element") {
    header.elements.push_back(parse_element(words, where));
  } else if (words[0] == "property") {
    if (header.elements.empty()) throw_invalid(where, "a property before any element", "name its element");
    header.elements.back().properties.push_back(parse_property(words, where));
  } else if (words[0] == "comment") {
    add_comment(words, header);
  } else if (words[0] != "obj_info") {
    throw_invalid(where, "unknown word \"" + std::string(words[0].substr(0, 40)) + "\" in the head",
                  "use format, element, property, comment, obj_info, end_header");
  }
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

PlyHeader parse_ply_header(std::string_view content, const std::string& file) {
  LineReader lines(content, file, '\0');
  if (!lines.next() || lines.line() != "ply")
    throw_invalid(file + ":1", "is no PLY file", "the first line of one is \"ply\"");
  PlyHeader header;
  Words words;
  while (lines.next()) {
    if (lines.line() == "end_header") {
      header.data_begin = lines.position();
      header.lines = lines.number();
      return header;
    }
    split_words(lines.line(), words);
    add_statement(words, lines.where(), header);
  }
  throw_invalid(file, "the head has no end", "a PLY head ends with \"end_header\"");
}

}  // namespace sunfleck
