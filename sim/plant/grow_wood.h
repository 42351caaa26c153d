// Wood of a drawn tree by the pipe model of Shinozaki et al. 1964: every foliage element is fed by one pipe,
// and r_parent^e = sum of r_child^e with e between 2 (cross-section kept) and 3.
#pragma once

#include <span>
#include <vector>

#include "sim/lsystem/lsystem.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// Cross-section kept at every fork (Shinozaki's model as it stands; Leonardo's rule). Larger exponents make
// twigs too thick: 2.6 down from the DBH gives half of the leaf area and more in wood, measured crowns have a
// tenth to a third.
inline constexpr double kPipeExponent = 2.0;

// Share of the cross-section at the stem foot that still feeds foliage; the rest are pipes of branches that
// were shed. Assumed: half, about the sapwood of grown conifers.
inline constexpr double kLivingShare = 0.5;

// Cross-section of living wood that feeds a square metre of leaves, at most: 5 cm2 (assumed, the upper range
// of measured Huber values). A stem thicker than that for its leaves is mostly disused.
inline constexpr double kMostLivingWood_m2_per_m2 = 5e-4;

// The share for a tree of this DBH and leaf area: kLivingShare, or less where the leaves are few.
double living_share(double dbh_m, double leaf_area_m2);

// Radius of each segment in units of one pipe. A segment's pipes are its organs' and its children's; a dead
// end (neither) counts as one. Parents come before their children, as the turtle draws them.
std::vector<double> pipe_radii(const lsystem::Drawing& drawing, double exponent);

// Segments as tapered wood of material 0, one for each: radii of the pipes, thickened by disused ones: with f
// the segment's share of all pipes, r^2 is times L + (1 - L) f, L the living share (1 at the foot, L in
// twigs). Each narrows to its thickest child, a tip to half.
std::vector<WoodSegment> piped_wood(const lsystem::Drawing& drawing, double exponent, double living_share);

// Which segments carry at least one of the chosen organs on themselves or above: what is left of the wood
// when only these organs stay, without bare twigs. All of them if none carries any.
std::vector<bool> carrying_segments(const lsystem::Drawing& drawing, std::span<const std::size_t> organs);

// Multiplies all radii so that the stem has the diameter at 1.3 m; a tree without a stem there gets it at its
// thickest place.
void scale_wood_to_dbh(Prototype& prototype, double dbh_m);

}  // namespace sunfleck
