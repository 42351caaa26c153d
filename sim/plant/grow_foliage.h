// Organs of a drawn tree as foliage elements: rhombic leaves or shoots of the species' template.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/lsystem/lsystem.h"
#include "sim/plant/species.h"

namespace sunfleck {

// A rhombus along the heading, its base at the turtle, its front to the turtle's up; area = length * width
// / 2.
FoliageElement rhombic_leaf(const lsystem::TurtleState& turtle, double length_m, double width_m);
// A shoot along the heading that begins at the turtle.
FoliageElement shoot_element(const lsystem::TurtleState& turtle, double length_m, double radius_m,
                             double area_m2);

// One-sided area of one element of the species' template.
double template_area_m2(const FoliageTemplate& foliage);

// Organs (indexes, ascending) that a tree of this leaf area keeps, drawn at random: as many as the template's
// size needs (all if those are fewer), times `detail`; at least one.
std::vector<std::size_t> choose_organs(std::size_t organs, const FoliageTemplate& foliage,
                                       double leaf_area_m2, double detail, std::uint64_t seed);

// Elements of the template at the chosen organs, whose areas sum to leaf_area_m2. They are scaled in all
// directions by the same factor, so shoots keep their silhouette to area ratio.
std::vector<FoliageElement> foliage_of(const std::vector<lsystem::Organ>& organs,
                                       std::span<const std::size_t> chosen, const FoliageTemplate& foliage,
                                       double leaf_area_m2);

}  // namespace sunfleck
