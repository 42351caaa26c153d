#include "lighting/plan/light_request.h"

#include <algorithm>
#include <utility>

#include "lighting/base/summaries.h"
#include "lighting/plan/auto_method.h"
#include "lighting/plan/run_method.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

const std::vector<std::pair<Method, std::string>>& methods() {
  static const std::vector<std::pair<Method, std::string>> table = {
      {Method::kReference, "reference"},
      {Method::kSingleScattering, "single_scattering"},
      {Method::kSpp, "spp"},
      {Method::kSppG, "spp_g"},
      {Method::kEnvelope, "envelope"},
      {Method::kEnvelopeMarched, "envelope_marched"},
      {Method::kGrid, "grid"},
      {Method::kAuto, "auto"}};
  return table;
}

void require_leaves(const Forest& forest, const ForestIndex& index) {
  if (forest.instances.empty()) throw_invalid("forest", "has no trees", "at least one instance");
  if (index.element_count() == 0)
    throw_invalid("forest", "has no foliage, so there is nothing to light", "trees with leaves");
}

// Takes away the light that cannot matter, so that no estimator works for it. Returns what was skipped.
std::vector<SkipNote> drop_idle_sources(Illumination& light) {
  const auto none = [&](double BandLight::*strength) {
    return std::all_of(light.bands.begin(), light.bands.end(),
                       [&](const BandLight& b) { return b.*strength == 0.0; });
  };
  std::vector<SkipNote> skipped;
  if (none(&BandLight::beam_normal_w_m2)) {
    skipped.push_back({"direct sun", "its irradiance is 0 in every band", 0.0});
  } else if (!light.sun_is_up()) {
    skipped.push_back({"direct sun", "the sun is at or below the horizon", 0.0});
    for (BandLight& b : light.bands) b.beam_normal_w_m2 = 0.0;
  }
  if (none(&BandLight::diffuse_horizontal_w_m2))
    skipped.push_back({"sky light", "its irradiance is 0 in every band", 0.0});
  return skipped;
}

// One note per skipped thing: an estimator may have said in its own words what was taken away before it.
void merge_skipped(std::vector<SkipNote>& notes, const std::vector<SkipNote>& first) {
  std::vector<SkipNote> merged = first;
  for (const SkipNote& note : notes)
    if (std::none_of(merged.begin(), merged.end(), [&](const SkipNote& m) { return m.what == note.what; }))
      merged.push_back(note);
  notes = std::move(merged);
}

void sign(LightMap& map, const Forest& forest, const LightRequest& request,
          const std::vector<SkipNote>& skipped) {
  Provenance& p = map.provenance;
  p.method = to_string(request.method);
  p.version = kVersion;
  p.forest_hash = content_hash(forest);
  if (request.method == Method::kReference || request.method == Method::kAuto)
    p.seed = request.reference.seed;
  merge_skipped(p.skipped, skipped);
  const auto light = describe_light(forest, request);
  p.settings.insert(p.settings.begin(), light.begin(), light.end());
}

}  // namespace

std::string to_string(Method method) {
  for (const auto& [value, name] : methods())
    if (value == method) return name;
  throw ContractViolation("unknown method");
}

Method method_from_string(const std::string& name, const std::string& where) {
  std::string known;
  for (const auto& [value, text] : methods()) {
    if (text == name) return value;
    known += (known.empty() ? "" : ", ") + text;
  }
  throw_invalid(where, "there is no method '" + name + "'", "one of " + known);
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& entry : methods()) list.push_back(entry.second);
    return list;
  }();
  return names;
}

LightMap compute_light_map(const Forest& forest, const LightRequest& request, const CostOptions& cost,
                           const RunControl& control) {
  validate(forest);
  const ForestIndex index(forest);
  require_leaves(forest, index);
  const OpticsTable optics(forest, request.optics);
  Illumination light = checked(request.light, optics.band_count());
  if (request.probes) check_options(*request.probes);
  const std::vector<SkipNote> skipped = drop_idle_sources(light);
  LightMap map;
  with_threads(cost.threads, [&] {
    map = run_method(forest, optics, light, request, control);
    if (request.probes && request.method != Method::kAuto)
      add_error_bars(forest, optics, light, *request.probes, request.reference.ground, map, control);
    sign(map, forest, request, skipped);
  });
  if (const std::string violation = find_violation(map, index); !violation.empty())
    throw ContractViolation("the result of " + map.provenance.method + " holds " + violation);
  return map;
}

}  // namespace sunfleck
