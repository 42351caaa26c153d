// Names that writer and reader of a stand study's NetCDF file share.
#pragma once

#include "lighting/map/stand_tables.h"

namespace sunfleck::stand_file {

inline constexpr char kFormatName[] = "sunfleck_format";
inline constexpr char kFormat[] = "stand study 1";
inline constexpr char kTable[] = "table";           // attribute: which table a variable belongs to
inline constexpr char kUnitWord[] = "column_unit";  // attribute: unit as in column names
inline constexpr char kPeriod[] = "_period", kError[] = "_standard_error";
inline constexpr char kTimeUnits[] = "seconds since 2000-01-01 00:00:00";

inline std::string variable_name(StandTarget target, const StandVariable& v) {
  return to_string(target) + "_" + v.name;
}

}  // namespace sunfleck::stand_file
