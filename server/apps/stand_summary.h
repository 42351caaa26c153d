// The summary a person reads after `sunfleck stand`.
#pragma once

#include "lighting/map/stand_tables.h"

namespace sunfleck {

void print_stand(const StandStudy& study, const StandTables& tables, const Forest& forest);

}  // namespace sunfleck
