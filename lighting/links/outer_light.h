// What links that end outside bring: sky light looked up by their directions, and the ground beyond the
// cells.
#pragma once

#include <span>
#include <vector>

#include "lighting/links/link_solver.h"
#include "lighting/sky/illumination.h"

namespace sunfleck::links {

// Per face.
struct OuterLight {
  std::vector<float> sky;     // irradiance by a sky of diffuse horizontal irradiance 1
  std::vector<float> beyond;  // share of the links that end on ground beyond the cells
};

OuterLight outer_light(const LinkTable& table, const trace::Receivers& receivers,
                       std::span<const SurfaceRange> ranges, const Illumination& light,
                       const RunControl& control);

}  // namespace sunfleck::links
