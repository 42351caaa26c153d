// What the instances of a forest put into the cells of the world grid.
#pragma once

#include <optional>

#include "lighting/transport/world_scene.h"

namespace sunfleck::transport {

// What one instance puts into the cells around it. Cells are numbered from the grid's lower corner on without
// going back into the period; beyond the grid's height they are its first and last layer.
struct InstanceContent {
  std::array<int, 3> lo{}, size{};
  std::vector<float> leaf_m2, wood_m2;

  std::size_t at(const std::array<int, 3>& cell) const {
    return (static_cast<std::size_t>(cell[2] - lo[2]) * static_cast<std::size_t>(size[1]) +
            static_cast<std::size_t>(cell[1] - lo[1])) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(cell[0] - lo[0]);
  }
  bool holds(const std::array<int, 3>& cell) const {
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) inside &= cell[a] >= lo[a] && cell[a] < lo[a] + size[a];
    return inside;
  }
};
InstanceContent instance_content(const WorldScene& scene, const Instance& instance);

// The cell of the grid for unwrapped indexes; none beyond the sides of a grid that does not repeat and beyond
// its top and bottom.
std::optional<std::uint32_t> grid_cell(const GridLayout& layout, std::array<int, 3> unwrapped);

// Fills `first_entry`, `entries` and `ranges`; the prototypes must be there.
void fill_contents(WorldScene& scene, const Forest& forest, const RunControl& control);

}  // namespace sunfleck::transport
