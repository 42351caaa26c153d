// How a picture is made, between the wire and the [render] table of scene files. A message becomes such a
// table and is read by read_render_settings(): the same keys, words, ranges and sentences. A new key of
// [render] needs a field of its name in v1::RenderSettings and a line in fill_message().
#pragma once

#include <string>

#include "lighting/render/render_config.h"
#include "server/convert/limits.h"
#include "server/convert/violations.h"

namespace sunfleck {

namespace v1 {
class RenderSettings;
}

// `camera`: a valid one, for the limit of pixels times samples.
RenderSettings render_settings_from_message(const v1::RenderSettings& message, const std::string& field,
                                            const Camera& camera, const Limits& limits,
                                            Violations& violations);

// For the client. Reads the image files that `settings` names: their pixels travel, never a path. Throws as
// read_texture() does. A max_samples_per_pixel of the default is left out, so that the server may take fewer.
void fill_message(const RenderSettings& settings, v1::RenderSettings& message);

}  // namespace sunfleck
