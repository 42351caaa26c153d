// Images on the wire: tiles while they come, whole files when they are finished.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lighting/render/render.h"
#include "server/convert/array_message.h"
#include "server/convert/violations.h"

namespace sunfleck {

namespace v1 {
class RenderTile;
class RenderSummary;
class StreamRenderRequest;
}  // namespace v1

enum class ImageFormat { kExr, kPng };

std::vector<ImageFormat> formats_from_message(const v1::StreamRenderRequest& message, Violations& violations);

// The rectangle [x0, x1) x [y0, y1) as half floats.
void fill_tile(const Image& image, int x0, int y0, int x1, int y1, v1::RenderTile& message);
void fill_summary(const Image& image, v1::RenderSummary& message);

// "image.exr" or "image.png" (by `tone`), and its bytes: written into `scratch`, read back, removed.
struct ImageFile {
  std::string name, bytes;
};
ImageFile encode(const Image& image, ImageFormat format, const ToneMap& tone,
                 const std::filesystem::path& scratch);
ArrayView view_of(const ImageFile& file);

}  // namespace sunfleck
