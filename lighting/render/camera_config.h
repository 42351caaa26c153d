// The [camera] table of a scene file as a Camera.
#pragma once

#include "lighting/render/render.h"
#include "sim/config/config_table.h"

namespace sunfleck {

// Keys: kind ("pinhole", "orthographic", "fisheye"), position_m, look_at_m, up (three numbers each),
// vertical_fov_deg, ortho_height_m, width_px, height_px, samples_per_pixel, seed. Others are refused.
Camera read_camera(const ConfigTable& table);

// Looks at the middle of a forest's box from the south, far enough to see all of it.
Camera default_camera(const Box& forest_bounds);

}  // namespace sunfleck
