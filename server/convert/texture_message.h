// Images on leaves and bark as pixels on the wire: whoever has the file reads it, whoever gets the message
// parses no image format and opens no path.
#pragma once

#include <string>
#include <vector>

#include "lighting/render/picture_look.h"
#include "server/convert/violations.h"

namespace sunfleck {

namespace v1 {
class RenderSettings;
}

std::vector<MaterialTextures> textures_from_message(const v1::RenderSettings& message,
                                                    const std::string& field, Violations& violations);

// Reads the files; throws as read_texture() does.
void fill_textures(const std::vector<MaterialTextures>& textures, v1::RenderSettings& message);

}  // namespace sunfleck
