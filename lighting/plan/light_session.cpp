#include "lighting/plan/light_session.h"

#include <algorithm>
#include <atomic>
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

const Forest& with_leaves(const Forest& forest) {
  validate(forest);
  if (forest.instances.empty()) throw_invalid("forest", "has no trees", "at least one instance");
  if (std::all_of(forest.instances.begin(), forest.instances.end(),
                  [&](const Instance& i) { return forest.prototypes[i.prototype.value].foliage.empty(); }))
    throw_invalid("forest", "has no foliage, so there is nothing to light", "trees with leaves");
  return forest;
}

// No two sessions share a prefix, whatever cache they use.
std::string next_prefix() {
  static std::atomic<std::uint64_t> count{0};
  return "session " + std::to_string(++count) + ": ";
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

void sign(LightMap& map, const LightScene& scene, const LightRequest& request,
          const std::vector<SkipNote>& skipped) {
  Provenance& p = map.provenance;
  p.method = to_string(request.method);
  p.version = kVersion;
  p.forest_hash = scene.forest_hash;
  if (request.method == Method::kReference || request.method == Method::kAuto)
    p.seed = request.reference.seed;
  merge_skipped(p.skipped, skipped);
  const auto light = describe_light(scene.forest, request);
  p.settings.insert(p.settings.begin(), light.begin(), light.end());
}

}  // namespace

LightSession::LightSession(const Forest& forest, std::shared_ptr<PreparedCache> cache)
    : forest_(with_leaves(forest)),
      index_(forest),
      forest_hash_(content_hash(forest)),
      cache_(std::move(cache)),
      store_{*cache_, next_prefix()} {}

LightSession::~LightSession() { cache_->forget(store_.prefix); }

LightMap LightSession::compute(const LightRequest& request, const CostOptions& cost,
                               const RunControl& control) const {
  const OpticsTable optics(forest_, request.optics);
  Illumination light = checked(request.light, optics.band_count());
  if (request.probes) check_options(*request.probes);
  const std::vector<SkipNote> skipped = drop_idle_sources(light);
  LightMap map;
  with_threads(cost.threads, [&] {
    map = run_method(scene(), optics, light, request, control);
    if (request.probes && request.method != Method::kAuto)
      add_error_bars(scene(), optics, light, *request.probes, request.reference.ground, map, control);
    sign(map, scene(), request, skipped);
  });
  if (const std::string violation = find_violation(map, index_); !violation.empty())
    throw ContractViolation("the result of " + map.provenance.method + " holds " + violation);
  return map;
}

}  // namespace sunfleck
