// Wood of a drawn tree by the pipe model of Shinozaki et al. 1964: every foliage element is fed by one pipe,
// and r_parent^e = sum of r_child^e with e between 2 (cross-section kept) and 3.
#pragma once

#include <span>
#include <vector>

#include "sim/lsystem/lsystem.h"
#include "sim/plant/prototype.h"

namespace sunfleck {

// Default exponent of Palubicki et al. 2009.
inline constexpr double kPipeExponent = 2.6;

// Radius of each segment in units of one pipe. A segment's pipes are its organs' and its children's; a dead
// end (neither) counts as one. Parents come before their children, as the turtle draws them.
std::vector<double> pipe_radii(const lsystem::Drawing& drawing, double exponent);

// Segments as tapered wood of material 0 with those radii: each narrows to its thickest child, a tip to half.
std::vector<WoodSegment> piped_wood(const lsystem::Drawing& drawing, double exponent);

// Multiplies all radii so that the stem has the diameter at 1.3 m; a tree without a stem there gets it at its
// thickest place.
void scale_wood_to_dbh(Prototype& prototype, double dbh_m);

}  // namespace sunfleck
