#include "lighting/render/texture_image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr int kMostPx = 16384;

double linear_from_srgb(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

int on_edge(int i, int size, TextureEdge edge) {
  if (edge == TextureEdge::kClamp) return std::clamp(i, 0, size - 1);
  const int rest = i % size;
  return rest < 0 ? rest + size : rest;
}

bool is_alpha(int channels, int channel) {
  return (channels == 2 || channels == 4) && channel == channels - 1;
}

void make_linear(std::vector<float>& values, int channels) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!is_alpha(channels, static_cast<int>(i % static_cast<std::size_t>(channels))))
      values[i] = static_cast<float>(linear_from_srgb(values[i]));
}

bool is_size(int width_px, int height_px) {
  return width_px >= 1 && height_px >= 1 && width_px <= kMostPx && height_px <= kMostPx;
}

std::size_t value_count(const TexturePixels& pixels) {
  return static_cast<std::size_t>(pixels.width_px) * static_cast<std::size_t>(pixels.height_px) *
         static_cast<std::size_t>(pixels.channels);
}

bool is_brightness(float value) { return std::isfinite(value) && value >= 0.0f; }

[[noreturn]] void refuse(const std::string& where, const std::filesystem::path& path,
                         const std::string& problem) {
  throw_invalid(where, "'" + path.string() + "' " + problem, "an image file (PNG, JPEG, TIFF, OpenEXR)");
}

}  // namespace

double TextureImage::at(const Vec2& place, int channel, TextureEdge edge) const {
  const double x = place.x * width_px - 0.5, y = (1.0 - place.y) * height_px - 0.5;
  const double left = std::floor(x), upper = std::floor(y), right_share = x - left, lower_share = y - upper;
  const auto value = [&](int column, int row) {
    const auto i =
        static_cast<std::size_t>(on_edge(row, height_px, edge)) * static_cast<std::size_t>(width_px) +
        static_cast<std::size_t>(on_edge(column, width_px, edge));
    return static_cast<double>(
        values[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(channel)]);
  };
  const int column = static_cast<int>(left), row = static_cast<int>(upper);
  return (1.0 - lower_share) * std::lerp(value(column, row), value(column + 1, row), right_share) +
         lower_share * std::lerp(value(column, row + 1), value(column + 1, row + 1), right_share);
}

Vec3 TextureImage::colour(const Vec2& place, TextureEdge edge) const {
  if (channels < 3) return Vec3(at(place, 0, edge));
  return {at(place, 0, edge), at(place, 1, edge), at(place, 2, edge)};
}

double TextureImage::alpha(const Vec2& place, TextureEdge edge) const {
  return at(place, channels == 2 || channels == 4 ? channels - 1 : 0, edge);
}

TexturePixels read_texture(const std::filesystem::path& path, TextureKind kind, const std::string& where) {
  if (!std::filesystem::is_regular_file(path))
    throw Error(ErrorKind::kNotFound, where, "there is no file '" + path.string() + "'",
                "the path of an image");
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
  if (!input) refuse(where, path, "cannot be read as an image: " + OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (!is_size(spec.width, spec.height) || spec.nchannels < 1)
    refuse(where, path,
           "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels");
  TexturePixels pixels{spec.width, spec.height, std::min(spec.nchannels, 4), {}, {}};
  const bool eight_bits = spec.format == OIIO::TypeDesc::UINT8;
  eight_bits ? pixels.bytes.resize(value_count(pixels)) : pixels.values.resize(value_count(pixels));
  void* const to = eight_bits ? static_cast<void*>(pixels.bytes.data()) : pixels.values.data();
  const OIIO::TypeDesc type = eight_bits ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT;
  if (!input->read_image(0, 0, 0, pixels.channels, type, to))
    refuse(where, path, "breaks off: " + input->geterror());
  if (!std::all_of(pixels.values.begin(), pixels.values.end(), is_brightness))
    refuse(where, path, "has pixels that are negative or not finite");
  if (kind == TextureKind::kColour && !spec.format.is_floating_point())
    make_linear(pixels.values, pixels.channels);
  return pixels;
}

TextureImage decoded(const TexturePixels& pixels, TextureKind kind, const std::string& where) {
  const auto refuse_pixels = [&](const std::string& problem) { throw_invalid(where, problem, "an image"); };
  if (!is_size(pixels.width_px, pixels.height_px) || pixels.channels < 1 || pixels.channels > 4)
    refuse_pixels("has " + std::to_string(pixels.width_px) + " x " + std::to_string(pixels.height_px) +
                  " pixels of " + std::to_string(pixels.channels) + " channels");
  if (pixels.bytes.size() + pixels.values.size() != value_count(pixels))
    refuse_pixels("has another number of values than width x height x channels");
  if (!std::all_of(pixels.values.begin(), pixels.values.end(), is_brightness))
    refuse_pixels("has pixels that are negative or not finite");
  TextureImage image{pixels.width_px, pixels.height_px, pixels.channels, pixels.values};
  for (const std::uint8_t byte : pixels.bytes) image.values.push_back(static_cast<float>(byte) / 255.0f);
  if (kind == TextureKind::kColour && !pixels.bytes.empty()) make_linear(image.values, image.channels);
  return image;
}

TextureImage load_texture(const std::filesystem::path& path, TextureKind kind, const std::string& where) {
  return decoded(read_texture(path, kind, where), kind, where);
}

}  // namespace sunfleck
