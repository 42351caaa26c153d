// Cameras between the wire and lighting/render.
#pragma once

#include <string>

#include "lighting/render/render.h"
#include "server/convert/limits.h"
#include "server/convert/violations.h"

namespace sunfleck {

namespace v1 {
class Camera;
}

Camera camera_from_message(const v1::Camera& message, const std::string& field, const Limits& limits,
                           Violations& violations);
void fill_message(const Camera& camera, v1::Camera& message);

}  // namespace sunfleck
