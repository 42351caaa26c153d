// Head comment in stand_json.h.
#include "server/client/stand_json.h"

#include <google/protobuf/util/json_util.h>

#include <charconv>
#include <cmath>
#include <cstring>

#include "server/convert/stand_answer.h"
#include "sim/base/error.h"
#include "sunfleck/v1/stand_light.pb.h"

namespace sunfleck {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + '"';
}

// As few digits as give the same number again.
template <class T>
void add_number(const std::byte* at, std::string& out) {
  T value;
  std::memcpy(&value, at, sizeof value);
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) {
      out += "null";
      return;
    }
  char text[40];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

template <class T>
void add_values(std::span<const std::byte> bytes, std::string& out) {
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) {
    if (i > 0) out += ',';
    add_number<T>(&bytes[i], out);
  }
}

void add_array(const ArrayView& array, std::string& out) {
  out += quoted(array.name) + ":{\"shape\":[";
  for (std::size_t i = 0; i < array.shape.size(); ++i)
    out += (i > 0 ? "," : "") + std::to_string(array.shape[i]);
  out += "],\"columns\":[";
  for (std::size_t i = 0; i < array.columns.size(); ++i) out += (i > 0 ? "," : "") + quoted(array.columns[i]);
  out += "],\"values\":[";
  if (array.type == ElementType::kFloat32) add_values<float>(array.bytes, out);
  if (array.type == ElementType::kFloat64) add_values<double>(array.bytes, out);
  if (array.type == ElementType::kUint32) add_values<std::uint32_t>(array.bytes, out);
  out += "]}";
}

std::string summary_json(const StandArrays& arrays) {
  v1::StandLightSummary summary;
  fill_summary(arrays, summary);
  if (summary.has_fit() && !std::isfinite(summary.fit().correlation()))
    summary.mutable_fit()->clear_correlation();
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(summary, &json, options);
  if (!status.ok()) throw Error(ErrorKind::kInputOutput, "summary", "cannot be written as JSON");
  return json;
}

}  // namespace

std::string stand_json(const StandStudy& study, const Forest* forest) {
  const StandArrays arrays(std::make_shared<const StandStudy>(study), forest);
  std::string out = "{\"summary\":" + summary_json(arrays) + ",\"arrays\":{";
  for (std::size_t i = 0; i < arrays.views().size(); ++i) {
    out += i > 0 ? ",\n" : "\n";
    add_array(arrays.views()[i], out);
  }
  return out + "}}\n";
}

}  // namespace sunfleck
