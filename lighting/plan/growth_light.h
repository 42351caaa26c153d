// Our own lighting as the light that trees grow by: what the method `grid` says of PAR where buds are, beside
// the quick approximation of sim/growth.
//
// Once a year the stand's leaves (as level discs turned to their normals, without wood) and small level
// probes on a lattice are lit by a uniform sky with all bounces between leaves and ground (grid_estimator.h).
// Light at a bud is the irradiance of the probes around it from above, interpolated, relative to open sky.
// Unlike the approximation it knows leaf angles and scattered light; as there, a bud's own cell shades it a
// little. Where it stops being true: gaps smaller than a cell are smeared.
#pragma once

#include "sim/forest/forest_spec.h"

namespace sunfleck {

// Looks at the stop token of `control` every year; throws what grid_light_map() throws.
BudLight growth_light_by_grid(const GrowthSite& site, const RunControl& control);

// grow_forest() with it: for whoever takes a spec from outside.
Forest grow_lit_forest(const ForestSpec& spec, const SpeciesLibrary& species, const RunControl& control,
                       std::vector<std::string>* notes = nullptr);

}  // namespace sunfleck
