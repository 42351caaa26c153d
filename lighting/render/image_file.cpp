// Images as files. EXR: linear floats in named layers. PNG: the same colours for the eye (tone_map.h).
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lighting/render/photograph_file.h"
#include "lighting/render/render.h"
#include "lighting/render/tone_map.h"
#include "sim/base/pending_file.h"

namespace sunfleck {
namespace {

constexpr std::size_t kExrChannels = 10;

// `format` decides what is written, whatever the name's extension.
void write_pixels(const std::filesystem::path& path, const char* format, const OIIO::ImageSpec& spec,
                  OIIO::TypeDesc type, const void* pixels) {
  PendingFile pending(path);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
  if (!output) throw_cannot_write(path, OIIO::geterror());
  if (!output->open(pending.path().string(), spec)) throw_cannot_write(path, output->geterror());
  if (!output->write_image(type, pixels)) throw_cannot_write(path, output->geterror());
  if (!output->close()) throw_cannot_write(path, output->geterror());
  pending.commit();
}

std::size_t pixel_count(const Image& image) { return image.depth_m.size(); }

std::vector<float> interleaved_layers(const Image& image) {
  std::vector<float> values;
  values.reserve(kExrChannels * pixel_count(image));
  for (std::size_t p = 0; p < pixel_count(image); ++p)
    values.insert(values.end(),
                  {image.rgb[3 * p], image.rgb[3 * p + 1], image.rgb[3 * p + 2], image.depth_m[p],
                   image.normal[3 * p], image.normal[3 * p + 1], image.normal[3 * p + 2],
                   image.instance_id[p], image.irradiance_w_m2[p], image.rgb_standard_error[p]});
  return values;
}

}  // namespace

void save_png(const HemisphericalPhotograph& photograph, const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(photograph.sky.size());
  for (const float share : photograph.sky)
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0f, 1.0f))));
  const OIIO::ImageSpec spec(photograph.pixels, photograph.pixels, 1, OIIO::TypeDesc::UINT8);
  write_pixels(path, "png", spec, OIIO::TypeDesc::UINT8, bytes.data());
}

void save_exr(const Image& image, const std::filesystem::path& path) {
  OIIO::ImageSpec spec(image.width_px, image.height_px, kExrChannels, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R",        "G",        "B",           "depth.Z",      "normal.X",
                       "normal.Y", "normal.Z", "instance.id", "irradiance.Y", "error.Y"};
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  // Without one, the library would write the time of day: equal pictures shall be equal files.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  write_pixels(path, "openexr", spec, OIIO::TypeDesc::FLOAT, interleaved_layers(image).data());
}

void save_png(const Image& image, const std::filesystem::path& path, const ToneMap& tone) {
  const std::vector<std::uint8_t> bytes = tone_mapped(image, tone);
  OIIO::ImageSpec spec(image.width_px, image.height_px, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  write_pixels(path, "png", spec, OIIO::TypeDesc::UINT8, bytes.data());
}

void save_png(const Image& image, const std::filesystem::path& path) { save_png(image, path, ToneMap{}); }

}  // namespace sunfleck
