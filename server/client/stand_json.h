// A stand study as JSON: the summary and all arrays of the wire, by their names
// (proto/sunfleck/v1/stand_light.proto). What is no number is null, a correlation without spread is left out.
#pragma once

#include <string>

#include "lighting/study/stand_study.h"

namespace sunfleck {

// {"summary": {...}, "arrays": {name: {"shape": [..], "columns": [..], "values": [..]}}}; values row-major.
// `forest`: the one of the study; null: without the array "plot".
std::string stand_json(const StandStudy& study, const Forest* forest);

}  // namespace sunfleck
