// Stand light requests between the wire and lighting/study.
#pragma once

#include <string>

#include "lighting/study/stand_cost.h"
#include "lighting/study/stand_study.h"
#include "server/convert/limits.h"
#include "server/convert/violations.h"
#include "sim/base/error.h"

namespace sunfleck {

namespace v1 {
class RadiationTable;
class StandLightCost;
class StandLightSpec;
}  // namespace v1

// Checks every field; what is wrong is added to `violations` with paths that start with `field`.
StandStudySpec stand_spec_from_message(const v1::StandLightSpec& message, const std::string& field,
                                       const Limits& limits, Violations& violations);
// Reads the radiation file where the spec names one; throws as read_radiation().
void fill_message(const StandStudySpec& spec, v1::StandLightSpec& message);

// Part of the two above. The table's name is its field path; unusable where violations were added.
RadiationTable radiation_from_message(const v1::RadiationTable& message, const std::string& field,
                                      Violations& violations);
void fill_message(const RadiationTable& table, const std::string& name, v1::RadiationTable& message);

// "stand_light.radiation.csv:3, column x" is field "stand_light.radiation.csv" and a description that begins
// with "line 3, column x: ".
Violation violation_of(const Error& error);
// What lighting says of a request (sensor in a stem, month without radiation) at the request's own field.
Violation violation_of(const Error& error, const StandStudySpec& spec, const std::string& field);

void fill_message(const StandCost& cost, v1::StandLightCost& message);
StandCost cost_from_message(const v1::StandLightCost& message);

}  // namespace sunfleck
