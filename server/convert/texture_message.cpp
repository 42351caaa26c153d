// Head comment in texture_message.h.
#include "server/convert/texture_message.h"

#include <bit>
#include <cstring>

#include "sim/base/error.h"
#include "sunfleck/v1/render.pb.h"

namespace sunfleck {
namespace {

static_assert(std::endian::native == std::endian::little);  // float pixels travel as they lie

constexpr std::size_t kMostEntries = 32;
constexpr int kMostPx = 4096;

const google::protobuf::FieldDescriptor* field_of(const TextureSlot& slot) {
  return v1::MaterialTextures::descriptor()->FindFieldByName(slot.name);
}

// The numbers of an image whose size is good; what they mean is checked by decoded().
TexturePixels pixels_of(const v1::TextureImage& image) {
  TexturePixels pixels{image.width_px(), image.height_px(), image.channels(), {}, {}};
  if (image.data_type() == v1::DATA_TYPE_UINT8) {
    pixels.bytes.assign(image.pixels().begin(), image.pixels().end());
  } else {
    pixels.values.resize(image.pixels().size() / sizeof(float));
    std::memcpy(pixels.values.data(), image.pixels().data(), pixels.values.size() * sizeof(float));
  }
  return pixels;
}

bool is_whole(const v1::TextureImage& image, const std::string& field, Violations& violations) {
  const bool width = violations.integer(field + ".width_px", image.width_px(), 1, kMostPx);
  const bool height = violations.integer(field + ".height_px", image.height_px(), 1, kMostPx);
  const bool channels = violations.integer(field + ".channels", image.channels(), 1, 4);
  const bool bytes = image.data_type() == v1::DATA_TYPE_UINT8;
  const bool type = bytes || image.data_type() == v1::DATA_TYPE_FLOAT32;
  if (!type) violations.add(field + ".data_type", "must be UINT8 or FLOAT32");
  if (!width || !height || !channels || !type) return false;
  const std::size_t wanted = static_cast<std::size_t>(image.width_px()) *
                             static_cast<std::size_t>(image.height_px()) *
                             static_cast<std::size_t>(image.channels()) * (bytes ? 1 : sizeof(float));
  if (image.pixels().size() == wanted) return true;
  violations.add(field + ".pixels", "must have width x height x channels values, that is " +
                                        std::to_string(wanted) + " bytes, got " +
                                        std::to_string(image.pixels().size()));
  return false;
}

std::shared_ptr<const TexturePixels> image_from_message(const v1::TextureImage& image, TextureKind kind,
                                                        const std::string& field, Violations& violations) {
  if (!is_whole(image, field, violations)) return nullptr;
  auto pixels = std::make_shared<const TexturePixels>(pixels_of(image));
  try {
    decoded(*pixels, kind, field);
  } catch (const Error& error) {
    violations.add(field + ".pixels", error.problem());
  }
  return pixels;
}

MaterialTextures entry_from_message(const v1::MaterialTextures& message, const std::string& field,
                                    Violations& violations) {
  MaterialTextures entry;
  entry.where = field;
  if (!message.material().empty() && violations.text(field + ".material", message.material(), 200))
    entry.material = message.material();
  const google::protobuf::Reflection& values = *message.GetReflection();
  for (const TextureSlot& slot : kTextureSlots) {
    if (!values.HasField(message, field_of(slot))) continue;
    const auto& image = static_cast<const v1::TextureImage&>(values.GetMessage(message, field_of(slot)));
    if (auto pixels = image_from_message(image, slot.kind, field + "." + slot.name, violations))
      entry.given[slot.name] = std::move(pixels);
  }
  return entry;
}

void fill_image(const TexturePixels& pixels, v1::TextureImage& image) {
  image.set_width_px(pixels.width_px);
  image.set_height_px(pixels.height_px);
  image.set_channels(pixels.channels);
  const bool bytes = !pixels.bytes.empty();
  image.set_data_type(bytes ? v1::DATA_TYPE_UINT8 : v1::DATA_TYPE_FLOAT32);
  const void* data = bytes ? static_cast<const void*>(pixels.bytes.data()) : pixels.values.data();
  image.set_pixels(data, bytes ? pixels.bytes.size() : pixels.values.size() * sizeof(float));
}

void fill_entry(const MaterialTextures& entry, v1::MaterialTextures& message) {
  message.set_material(entry.material);
  google::protobuf::Reflection const& values = *message.GetReflection();
  for (const TextureSlot& slot : kTextureSlots) {
    const auto given = entry.given.find(slot.name);
    const bool is_given = given != entry.given.end();
    if (!is_given && (entry.*slot.file).empty()) continue;
    const std::string where = entry.where.empty() ? slot.name : entry.where + "." + slot.name;
    auto& image = static_cast<v1::TextureImage&>(*values.MutableMessage(&message, field_of(slot)));
    fill_image(is_given ? *given->second : read_texture(entry.*slot.file, slot.kind, where), image);
  }
}

}  // namespace

std::vector<MaterialTextures> textures_from_message(const v1::RenderSettings& message,
                                                    const std::string& field, Violations& violations) {
  std::vector<MaterialTextures> textures;
  const auto count = static_cast<std::size_t>(message.textures_size());
  if (!violations.count(field, count, 0, kMostEntries)) return textures;
  for (std::size_t i = 0; i < count; ++i)
    textures.push_back(entry_from_message(message.textures(static_cast<int>(i)), at(field, i), violations));
  return textures;
}

void fill_textures(const std::vector<MaterialTextures>& textures, v1::RenderSettings& message) {
  for (const MaterialTextures& entry : textures) fill_entry(entry, *message.add_textures());
}

}  // namespace sunfleck
