// See grid_notes.h.
#include "lighting/transport/grid_notes.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace sunfleck::transport {

namespace {

std::string few_elements_note(const Forest& forest) {
  std::size_t few = 0;
  std::ostringstream out;
  for (const Prototype& p : forest.prototypes) {
    if (p.foliage.empty() || p.foliage.size() >= kFewElements) continue;
    if (few++ == 0) out << "prototype '" << p.name << "' has " << p.foliage.size() << " foliage elements (";
  }
  if (few == 0) return {};
  out << few << " prototypes have fewer than " << kFewElements
      << "): too few for a random medium, light may be wrong by 10 % and more; method 'reference' suits such "
         "plants";
  return out.str();
}

std::string cell_note(const BlockerField& field) {
  const double cell = field.layout().mean_cell_m(), sides = cell / field.mean_side_m();
  std::ostringstream out;
  out << std::setprecision(3) << "cells of " << cell << " m (" << sides << " leaf sides) ";
  if (field.layout().coarsened) {
    out << "blur the crowns: smaller ones would not fit the memory limit";
    return out.str();
  }
  if (sides >= kFewestSides) return {};
  out << "are smaller than " << kFewestSides << " leaf sides: light may be wrong by tens of percent; give "
      << 2.0 * field.mean_side_m() << " to " << 4.0 * field.mean_side_m() << " m";
  return out.str();
}

std::string buried_note(const BlockerField& field) {
  const auto buried = std::ranges::count_if(field.elements(), [](const auto& e) { return e.below_ground; });
  if (buried == 0) return {};
  return std::to_string(buried) + " foliage elements lie below the ground and get no light";
}

}  // namespace

std::vector<std::string> grid_notes(const Forest& forest, const TransportScene& scene) {
  std::vector<std::string> notes;
  for (std::string note : {few_elements_note(forest), cell_note(*scene.field), buried_note(*scene.field)})
    if (!note.empty()) notes.push_back(std::move(note));
  if (!scene.contents.wood.empty())
    notes.push_back("all wood reflects by the mean bark reflectance, evenly over its surface in a cell");
  return notes;
}

}  // namespace sunfleck::transport
