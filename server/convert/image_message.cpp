// Head comment in image_message.h.
#include "server/convert/image_message.h"

#include <atomic>
#include <fstream>
#include <numeric>
#include <sstream>

#include "server/convert/crc32c.h"
#include "server/convert/half.h"
#include "sim/base/error.h"
#include "sunfleck/v1/render.pb.h"

namespace sunfleck {
namespace {

double mean_of(const std::vector<float>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// A name in the scratch folder that no other call of this process uses.
std::filesystem::path unused_path(const std::filesystem::path& scratch, const std::string& name) {
  static std::atomic<std::uint64_t> count{0};
  return scratch / (std::to_string(++count) + "-" + name);
}

// Removes the file when it goes out of scope, come what may.
struct PassingFile {
  std::filesystem::path path;
  ~PassingFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

}  // namespace

std::vector<ImageFormat> formats_from_message(const v1::StreamRenderRequest& message,
                                              Violations& violations) {
  std::vector<ImageFormat> formats;
  violations.count("formats", static_cast<std::size_t>(message.formats_size()), 0, 2);
  for (int i = 0; i < message.formats_size(); ++i) {
    switch (message.formats(i)) {
      case v1::IMAGE_FORMAT_EXR:
        formats.push_back(ImageFormat::kExr);
        break;
      case v1::IMAGE_FORMAT_PNG:
        formats.push_back(ImageFormat::kPng);
        break;
      default:
        violations.add(at("formats", static_cast<std::size_t>(i)), "must be EXR or PNG");
    }
  }
  return formats;
}

void fill_tile(const Image& image, int x0, int y0, int x1, int y1, v1::RenderTile& message) {
  message.set_x0_px(x0);
  message.set_y0_px(y0);
  message.set_width_px(x1 - x0);
  message.set_height_px(y1 - y0);
  std::string& bytes = *message.mutable_rgb_float16();
  bytes.reserve(static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0) * 6);
  for (int y = y0; y < y1; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width_px);
    for (std::size_t i = 3 * (row + static_cast<std::size_t>(x0));
         i < 3 * (row + static_cast<std::size_t>(x1)); ++i) {
      const std::uint16_t half = half_bits(image.rgb[i]);
      bytes.push_back(static_cast<char>(half & 0xff));
      bytes.push_back(static_cast<char>(half >> 8));
    }
  }
  message.set_crc32c(crc32c(bytes));
}

void fill_summary(const Image& image, v1::RenderSummary& message) {
  message.set_mean_rgb(mean_of(image.rgb));
  message.set_mean_rgb_standard_error(mean_of(image.rgb_standard_error));
  message.set_samples_per_pixel(image.samples_per_pixel);
  message.set_noise(image_noise(image));
  message.set_stopped(image.stopped);
}

ImageFile encode(const Image& image, ImageFormat format, const ToneMap& tone,
                 const std::filesystem::path& scratch) {
  const std::string name = format == ImageFormat::kExr ? "image.exr" : "image.png";
  const PassingFile file{unused_path(scratch, name)};
  format == ImageFormat::kExr ? save_exr(image, file.path) : save_png(image, file.path, tone);
  std::ifstream in(file.path, std::ios::binary);
  std::ostringstream bytes;
  if (!(bytes << in.rdbuf())) throw Error(ErrorKind::kInputOutput, file.path.string(), "cannot be read back");
  return {name, std::move(bytes).str()};
}

ArrayView view_of(const ImageFile& file) {
  return {file.name,
          ElementType::kUint8,
          {file.bytes.size()},
          {},
          std::as_bytes(std::span<const char>(file.bytes.data(), file.bytes.size()))};
}

}  // namespace sunfleck
