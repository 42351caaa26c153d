// Head comment in render_settings_message.h.
#include "server/convert/render_settings_message.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "server/convert/texture_message.h"
#include "sim/base/error.h"
#include "sunfleck/v1/render.pb.h"

namespace sunfleck {
namespace {

using google::protobuf::FieldDescriptor;

bool is_word(const std::string& text) {
  const auto is_plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return text.size() <= 60 && std::all_of(text.begin(), text.end(), is_plain);
}

std::string printed(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

// Keys and values as TOML; what can be none is a violation already.
using Lines = std::map<std::string, std::string>;

std::string toml_value(const v1::RenderSettings& message, const FieldDescriptor* key) {
  const google::protobuf::Reflection& values = *message.GetReflection();
  switch (key->cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return values.GetBool(message, key) ? "true" : "false";
    case FieldDescriptor::CPPTYPE_INT32:
      return std::to_string(values.GetInt32(message, key));
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return printed(values.GetDouble(message, key));
    default:
      return '"' + values.GetString(message, key) + '"';
  }
}

Lines lines_of(const v1::RenderSettings& message, const std::string& field, Violations& violations) {
  Lines lines;
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  const google::protobuf::Reflection& values = *message.GetReflection();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor* key = type.field(i);
    if (key->is_repeated() || !values.HasField(message, key)) continue;
    const bool is_text = key->cpp_type() == FieldDescriptor::CPPTYPE_STRING;
    if (is_text && !is_word(values.GetString(message, key)))
      violations.add(field + "." + key->name(), "must be a word of small letters, got '" +
                                                    clipped(values.GetString(message, key)) + "'");
    else
      lines[key->name()] = toml_value(message, key);
  }
  return lines;
}

// The key at the end of "request:3: mode".
std::string key_of(const Error& error) {
  const std::size_t colon = error.where().rfind(": ");
  return colon == std::string::npos ? error.where() : error.where().substr(colon + 2);
}

// Reads the table again without each key that is refused, so that all are told at once.
RenderSettings read_lines(Lines lines, const std::string& field, Violations& violations) {
  for (;;) {
    std::string text;
    for (const auto& [key, value] : lines) text += key + " = " + value + "\n";
    try {
      const ConfigTable table = ConfigTable::from_text(text, "request");
      const RenderSettings settings = read_render_settings(table);
      table.reject_unread();
      return settings;
    } catch (const Error& error) {
      const std::string key = key_of(error);
      violations.add(field + "." + key, error.problem() + " (" + error.remedy() + ")");
      if (lines.erase(key) == 0) return {};
    }
  }
}

// A noise target may take as many samples as the server allows for a picture of that size.
void limit_samples(const v1::RenderSettings& message, const std::string& field, const Camera& camera,
                   const Limits& limits, Violations& violations, RenderEffort& effort) {
  if (effort.noise <= 0.0 || camera.width_px < 1 || camera.height_px < 1) return;
  const auto pixels =
      static_cast<std::uint64_t>(camera.width_px) * static_cast<std::uint64_t>(camera.height_px);
  const std::uint64_t most = std::max<std::uint64_t>(1, limits.image_samples / pixels);
  if (static_cast<std::uint64_t>(effort.max_samples_per_pixel) <= most) return;
  if (message.has_max_samples_per_pixel())
    violations.add(field + ".max_samples_per_pixel",
                   "must keep pixels times samples within " + std::to_string(limits.image_samples) +
                       ": at most " + std::to_string(most) + " for a picture of this size, got " +
                       std::to_string(effort.max_samples_per_pixel));
  effort.max_samples_per_pixel = static_cast<int>(most);
}

}  // namespace

RenderSettings render_settings_from_message(const v1::RenderSettings& message, const std::string& field,
                                            const Camera& camera, const Limits& limits,
                                            Violations& violations) {
  RenderSettings settings = read_lines(lines_of(message, field, violations), field, violations);
  limit_samples(message, field, camera, limits, violations, settings.effort);
  settings.look.textures = textures_from_message(message, field + ".textures", violations);
  return settings;
}

void fill_message(const RenderSettings& s, v1::RenderSettings& message) {
  message.set_mode(to_string(s.mode));
  message.set_noise(s.effort.noise);
  if (s.effort.max_samples_per_pixel != RenderEffort{}.max_samples_per_pixel)
    message.set_max_samples_per_pixel(s.effort.max_samples_per_pixel);
  message.set_leaf_sun(to_string(s.leaf_sun));
  message.set_leaf_outline(to_string(s.look.outline));
  message.set_patterns(s.look.patterns);
  message.set_leaf_gloss(s.look.leaf_gloss);
  message.set_gloss_exponent(s.look.gloss_exponent);
  message.set_bark_width_m(s.look.bark_width_m);
  message.set_ground(to_string(s.look.ground));
  message.set_tone(to_string(s.tone.curve));
  message.set_exposure_stops(s.tone.exposure_stops);
  message.set_detail(to_string(s.detail));
  message.set_detail_tolerance(s.detail.tolerance);
  message.set_needles(to_string(s.look.shoots));
  fill_textures(s.look.textures, message);
}

}  // namespace sunfleck
