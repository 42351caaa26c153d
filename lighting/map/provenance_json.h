// The lists of a provenance as JSON text, for files whose attributes are flat. Numbers survive exactly.
#pragma once

#include <string>

#include "lighting/base/light_map.h"

namespace sunfleck {

std::string settings_to_json(const Provenance& provenance);  // [["name_unit", "value"], ...]
std::string skipped_to_json(const Provenance& provenance);   // [{"what", "reason", "relative_bound"}, ...]
std::string notes_to_json(const Provenance& provenance);     // ["...", ...]
std::string times_to_json(const Provenance& provenance);     // [{"stage", "wall_s", "cpu_s"}, ...]

// The lists back into `provenance`; throw Error(kInvalidInput) naming `where` on other JSON.
struct ProvenanceJson {
  std::string settings, skipped, notes, times;
};
void read_json(const ProvenanceJson& json, const std::string& where, Provenance& provenance);

}  // namespace sunfleck
