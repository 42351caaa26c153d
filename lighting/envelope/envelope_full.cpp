// See envelope_full.h.
#include "lighting/envelope/envelope_full.h"

#include <sstream>

#include "lighting/base/summaries.h"
#include "lighting/envelope/envelope_query.h"
#include "lighting/envelope/envelope_suitability.h"
#include "sim/base/version.h"

namespace sunfleck {

namespace {

using namespace envelope;

constexpr std::size_t kChunk = 256;  // leaves; 50 directions take 5 us each

std::string number(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

LightMap empty_map(const ForestIndex& index, const OpticsTable& optics, const PreparedParts& parts) {
  LightMap map;
  map.sunlit_fraction.resize(index.element_count());
  for (const std::string& band : optics.bands()) {
    BandLightMap& added = map.bands.emplace_back();
    added.band = band;
    added.elements.resize(index.element_count());
  }
  map.provenance.method = "envelope_full";
  map.provenance.version = kVersion;
  map.provenance.forest_hash = parts.forest_hash;
  return map;
}

void state_settings(Provenance& provenance, const PreparedParts& parts) {
  const EnvelopeFullOptions& o = parts.options;
  provenance.settings = {{"directions", std::to_string(parts.set.count())},
                         {"sun", to_string(o.sun)},
                         {"angles", to_string(o.angles)},
                         {"bounces", to_string(o.bounces)},
                         {"ground", to_string(o.ground)},
                         {"weights", to_string(o.weights)},
                         {"own_leaf", to_string(o.own_leaf)},
                         {"border", to_string(o.border)},
                         {"cell_m", number(parts.field->layout().mean_cell_m())},
                         {"cells", std::to_string(parts.field->layout().cell_count())}};
}

void state_skips(Provenance& provenance, const Illumination& light, const OpticsTable& optics) {
  if (!has_sun(light))
    provenance.skipped.push_back(
        {"direct sun and its bounce",
         light.sun_is_up() ? "no band has direct sunlight" : "the sun is not above the horizon", 0.0});
  double soil = 0.0;
  for (std::size_t b = 0; b < optics.band_count(); ++b) soil = std::max(soil, optics.soil_albedo(b));
  if (soil == 0.0) provenance.skipped.push_back({"light of the ground", "it is black in every band", 0.0});
}

void state_limits(Provenance& provenance, const EnvelopeSuitability& suitability) {
  for (const EnvelopeCondition& condition : suitability.conditions)
    if (!condition.met)
      provenance.notes.push_back("outside its range (" + condition.name + " " + number(condition.value) +
                                 ", limit " + number(condition.limit) + "): " + condition.consequence);
}

}  // namespace

LightMap envelope_full_light_map(const Forest& forest, const OpticsTable& optics,
                                 const Illumination& illumination, const EnvelopePrepared& prepared,
                                 const RunControl& control) {
  const PreparedParts& parts = prepared.parts();
  const ForestIndex index(forest);
  LightMap map = empty_map(index, optics, parts);
  map.provenance.times = parts.times;
  std::optional<EnvelopeQuery> query;
  {
    const StageTimer timer(map.provenance, "sources");
    query.emplace(forest, optics, illumination, prepared, control);
  }
  {
    const StageTimer timer(map.provenance, "evaluation");
    const std::vector<float> sun_depths = query->parts_->sun_depths(control);
    for_each_chunk(index.element_count(), kChunk, control, "evaluating leaves",
                   [&](std::size_t begin, std::size_t end) {
                     ArrivingLight light(parts, query->parts_->sources);
                     EnvelopeAnswer answer;
                     for (std::size_t i = begin; i < end; ++i) {
                       query->parts_->element(i, sun_depths[i], light, answer);
                       map.sunlit_fraction[i] = static_cast<float>(answer.sunlit);
                       for (std::size_t b = 0; b < map.bands.size(); ++b)
                         map.bands[b].elements[i] = answer.bands[b];
                     }
                   });
  }
  summarize(forest, index, optics, map);
  state_settings(map.provenance, parts);
  state_skips(map.provenance, checked(illumination, optics.band_count()), optics);
  state_limits(map.provenance, envelope_suitability(forest, optics, prepared));
  SUNFLECK_ENSURES(find_violation(map, index).empty());
  return map;
}

LightMap envelope_full_light_map(const Forest& forest, const OpticsTable& optics, const Illumination& light,
                                 const EnvelopeFullOptions& options, const RunControl& control) {
  const Illumination good = checked(light, optics.band_count());  // before any work
  return envelope_full_light_map(forest, optics, good, prepare_envelope(forest, options, control), control);
}

}  // namespace sunfleck
