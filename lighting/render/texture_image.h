// Images read from files, as numbers to look up. Bilinear between pixel centres.
#pragma once

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

// Throws Error(kNotFound / kInvalidInput) at `where` with the file's name: not there, not an image, no
// pixels, more than 16384 on a side.
TextureImage load_texture(const std::filesystem::path& path, TextureKind kind, const std::string& where);

}  // namespace sunfleck
