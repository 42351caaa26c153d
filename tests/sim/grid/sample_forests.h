// Small forests that touch every member of every struct, for round trips.
#pragma once

#include <cstddef>

#include "sim/forest/forest.h"

namespace sunfleck::test {

Forest varied_forest();  // all shapes, wood, mesh, slope, period, awkward names and numbers
Forest large_forest(std::size_t elements);  // one crown of parallelograms
Forest empty_forest();
Forest leafless_forest();  // a stem, and a prototype of nothing at all

}  // namespace sunfleck::test
