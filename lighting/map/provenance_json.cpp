#include "lighting/map/provenance_json.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

using Json = nlohmann::ordered_json;

// Text that is not UTF-8 is written with replacement characters rather than refused.
std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

// JSON has no infinity: null stands for "no bound is known".
double bound_of(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

}  // namespace

std::string settings_to_json(const Provenance& provenance) {
  Json list = Json::array();
  for (const auto& [name, value] : provenance.settings) list.push_back(Json::array({name, value}));
  return dump(list);
}

std::string skipped_to_json(const Provenance& provenance) {
  Json list = Json::array();
  for (const SkipNote& note : provenance.skipped)
    list.push_back({{"what", note.what}, {"reason", note.reason}, {"relative_bound", note.relative_bound}});
  return dump(list);
}

std::string notes_to_json(const Provenance& provenance) { return dump(Json(provenance.notes)); }

std::string times_to_json(const Provenance& provenance) {
  Json list = Json::array();
  for (const StageTime& time : provenance.times)
    list.push_back({{"stage", time.stage}, {"wall_s", time.wall_s}, {"cpu_s", time.cpu_s}});
  return dump(list);
}

void read_json(const ProvenanceJson& json, const std::string& where, Provenance& provenance) {
  try {
    for (const Json& pair : Json::parse(json.settings))
      provenance.settings.emplace_back(pair.at(0).get<std::string>(), pair.at(1).get<std::string>());
    for (const Json& note : Json::parse(json.skipped))
      provenance.skipped.push_back({note.at("what").get<std::string>(), note.at("reason").get<std::string>(),
                                    bound_of(note.at("relative_bound"))});
    provenance.notes = Json::parse(json.notes).get<std::vector<std::string>>();
    for (const Json& time : Json::parse(json.times))
      provenance.times.push_back({time.at("stage").get<std::string>(), time.at("wall_s").get<double>(),
                                  time.at("cpu_s").get<double>()});
  } catch (const Json::exception& failure) {
    throw_invalid(where, std::string("its provenance is not the JSON of a light map: ") + failure.what(),
                  "save the light map again");
  }
}

}  // namespace sunfleck
