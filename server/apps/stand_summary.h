// The summary a person reads after `sunfleck stand`, and from `sunfleck info` of its NetCDF file.
#pragma once

#include "lighting/map/stand_tables.h"

namespace sunfleck {

void print_stand(const StandTables& tables, const std::string& name);

}  // namespace sunfleck
