// A map of the ground as a picture: cells in colour, a colour bar, axes in metres, stems and sensors on top.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lighting/canopy/stand_scene.h"

namespace sunfleck {

struct MapMark {
  Vec2 at_m{0};
  double radius_m = 0;  // 0: a point of fixed size
  std::string label = {};
};

struct GroundPicture {
  std::string title, value_label;  // the colour bar's, with unit
  std::vector<double> value;       // per cell of the map
  double from = 0, to = 0;         // of the colour bar; equal: chosen from the values
  std::vector<MapMark> stems = {}, sensors = {};
  int width_px = 900;
};

// .png; equal scales in x and y. Throws Error(kInvalidInput): not one value per cell, another extension;
// kInputOutput as draw_plots().
void draw_ground(const StandGround& map, const GroundPicture& picture, const std::filesystem::path& path);

}  // namespace sunfleck
