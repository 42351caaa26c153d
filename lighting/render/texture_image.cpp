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

bool is_alpha(const TextureImage& image, int channel) {
  return (image.channels == 2 || image.channels == 4) && channel == image.channels - 1;
}

void make_linear(TextureImage& image) {
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (!is_alpha(image, static_cast<int>(i % static_cast<std::size_t>(image.channels))))
      image.values[i] = static_cast<float>(linear_from_srgb(image.values[i]));
}

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

TextureImage load_texture(const std::filesystem::path& path, TextureKind kind, const std::string& where) {
  if (!std::filesystem::is_regular_file(path))
    throw Error(ErrorKind::kNotFound, where, "there is no file '" + path.string() + "'",
                "the path of an image");
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
  if (!input) refuse(where, path, "cannot be read as an image: " + OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMostPx || spec.height > kMostPx ||
      spec.nchannels < 1)
    refuse(where, path,
           "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels");
  TextureImage image{spec.width, spec.height, std::min(spec.nchannels, 4), {}};
  image.values.resize(static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px) *
                      static_cast<std::size_t>(image.channels));
  if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.values.data()))
    refuse(where, path, "breaks off: " + input->geterror());
  if (!std::all_of(image.values.begin(), image.values.end(),
                   [](float v) { return std::isfinite(v) && v >= 0.0f; }))
    refuse(where, path, "has pixels that are negative or not finite");
  if (kind == TextureKind::kColour && !spec.format.is_floating_point()) make_linear(image);
  return image;
}

}  // namespace sunfleck
