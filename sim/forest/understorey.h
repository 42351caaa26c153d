// Trees that an inventory left out because they are small. They shade whatever is measured near the ground,
// and most where it is light.
//
// How many: stand inventories stop at a diameter (callipering limit). In stands that regenerate, stem numbers
// fall towards thicker trees in a geometric series (de Liocourt 1898; Meyer 1952: by a factor of 1.3 to 1.5
// per 5 cm in balanced uneven-aged forests), so the stems of the two classes above the limit tell how many
// are below. Where: regeneration follows light: a place is taken with a chance in proportion to the light
// that the measured crowns above it let through (Beer's law with K = 0.5), to the power `light_power`.
// Species are drawn from the smallest measured trees; crowns by the species' allometry, heights on the chord
// of its height curve.
//
// The limit, where it is not given: the lower edge of the 2.5 cm class under 30 cm with the most stems (the
// completeness magnitude of earthquake catalogues is found so: Wiemer and Wyss 2000), if all smaller stems
// are fewer than half of those in it. Otherwise the diameters do not look cut off (even-aged stands are
// bell-shaped): nothing is added.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/forest/forest_spec.h"

namespace sunfleck {

// The callipering limit that the diameters show, in cm; none if they do not look cut off.
std::optional<double> calliper_limit_cm(const std::vector<InventoryTree>& trees);

// Stems between the smallest diameter and the limit that the series asks for, less those measured there.
double missing_stems(const std::vector<InventoryTree>& trees, double limit_cm, const Understorey& options);

// The trees to add, with virtual numbers from kFirstUnderstorey; says in `notes` how many and why. Throws
// Error(kInvalidInput): options out of range.
std::vector<InventoryTree> understorey_trees(const std::vector<InventoryTree>& trees, const PlotPolygon& plot,
                                             const Understorey& options, const SpeciesLibrary& species,
                                             std::uint64_t seed, std::vector<std::string>& notes);

inline constexpr std::size_t kFirstUnderstorey = 1'000'000'000;

}  // namespace sunfleck
