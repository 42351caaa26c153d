// Images read from files, as numbers to look up. Bilinear between pixel centres.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

enum class TextureEdge { kClamp, kRepeat };

struct TextureImage {
  int width_px = 0, height_px = 0, channels = 0;
  std::vector<float> values;  // top row first, channels interleaved, 0 to 1 for images of 8 and 16 bits

  // Place (0, 0) is the lower left corner, (1, 1) the upper right one.
  double at(const Vec2& place, int channel, TextureEdge edge) const;
  // Red, green and blue; grey images give the same three times.
  Vec3 colour(const Vec2& place, TextureEdge edge) const;
  // The last channel of images with 2 or 4, else the first.
  double alpha(const Vec2& place, TextureEdge edge) const;
};

enum class TextureKind { kColour, kNumbers };  // colour of 8 and 16 bits is made linear (sRGB)

// An image's pixels as they were stored, for whom the file is out of reach: 8-bit images as their bytes
// (colours in sRGB), all others as the numbers of a TextureImage (linear).
struct TexturePixels {
  int width_px = 0, height_px = 0, channels = 0;  // 1 to 4 channels
  std::vector<std::uint8_t> bytes;                // either these, top row first, channels interleaved
  std::vector<float> values;                      // or these
};

// Throws Error(kNotFound / kInvalidInput) at `where` with the file's name: not there, not an image, no
// pixels, more than 16384 on a side.
TexturePixels read_texture(const std::filesystem::path& path, TextureKind kind, const std::string& where);
// Throws Error(kInvalidInput) at `where`: no pixels, more than 16384 on a side, another number of values than
// width x height x channels, negative or not finite ones.
TextureImage decoded(const TexturePixels& pixels, TextureKind kind, const std::string& where);
// The two in a row.
TextureImage load_texture(const std::filesystem::path& path, TextureKind kind, const std::string& where);

}  // namespace sunfleck
