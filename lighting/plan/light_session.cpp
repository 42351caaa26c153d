#include "lighting/plan/light_session.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>
#include <utility>

#include "lighting/base/summaries.h"
#include "lighting/plan/auto_method.h"
#include "lighting/plan/kept_methods.h"
#include "lighting/plan/near_light.h"
#include "lighting/plan/run_method.h"
#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"
#include "sim/base/version.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostWorldElements = 50'000'000;  // 1.4 GB per band

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

bool bounces_skipped(const Plan& plan) {
  return std::any_of(plan.skips.begin(), plan.skips.end(), [](const PlannedSkip& skip) {
    return std::any_of(skip.bound_w_m2.begin(), skip.bound_w_m2.end(), [](double x) { return x > 0.0; });
  });
}

LightRequest with_bounces(LightRequest request, const Plan& plan) {
  if (plan.one_bounce) request.reference.max_iterations = request.grid.max_iterations = 1;
  return request;
}

// What elements absorb follows from their true optics; an energy budget without the skipped light would not
// close, and a series that was cut on purpose did not fail to converge.
void take_true_optics(const LightScene& scene, const OpticsTable& optics, const Plan& plan, LightMap& map) {
  summarize(scene.forest, scene.index, optics, map);
  for (BandLightMap& band : map.bands) {
    band.has_budget = false;
    band.budget = {};
  }
  if (plan.one_bounce)
    std::erase_if(map.provenance.notes,
                  [](const std::string& n) { return n.find("had not converged") != std::string::npos; });
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

int threads_of(const CostOptions& cost) {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return cost.threads > 0 ? std::min(cost.threads, cores) : cores;
}

}  // namespace

LightSession::LightSession(const Forest& forest, std::shared_ptr<PreparedCache> cache)
    : forest_(with_leaves(forest)),
      index_(forest),
      forest_hash_(content_hash(forest)),
      cache_(std::move(cache)),
      store_{*cache_, next_prefix()} {}

LightSession::~LightSession() { cache_->forget(store_.prefix); }

Plan LightSession::plan(const LightRequest& request) const { return make_plan(forest_, index_, request); }

// Only the trees asked for are ever touched leaf by leaf.
LightMap LightSession::compute_world(const LightRequest& request, const CostOptions& cost,
                                     const RunControl& control) const {
  const Plan plan = this->plan(request);
  const Forest chosen =
      request.selection.everything() ? forest_ : selected_forest(forest_, request.selection);
  std::vector<std::uint32_t> instances(forest_.instances.size());
  std::iota(instances.begin(), instances.end(), 0u);
  if (!request.selection.everything()) instances = selected_instances(forest_, request.selection);
  const ForestIndex index(chosen);
  if (index.element_count() > kMostWorldElements)
    throw Error(ErrorKind::kLimitExceeded, "selection",
                std::to_string(index.element_count()) + " leaves are asked for", "fewer trees at once");
  const OpticsTable optics(forest_, request.optics), seen(forest_, plan.optics);
  const LightScene scene = this->scene(cost.threads);
  LightMap map;
  with_threads(cost.threads, [&] {
    map = kept_world_light_map(scene, seen, plan.light, request.world, instances, control);
    summarize(chosen, index, OpticsTable(chosen, request.optics), map);
    if (request.probes && request.selection.everything())
      add_error_bars(scene, optics, plan.light, *request.probes, request.reference.ground, map, control);
    sign(map, scene, request, skip_notes(plan, map));
  });
  map.provenance.settings.emplace_back("selection", std::to_string(instances.size()) + " of " +
                                                        std::to_string(forest_.instances.size()) + " trees");
  if (const std::string violation = find_violation(map, index); !violation.empty())
    throw ContractViolation("the result of world holds " + violation);
  return map;
}

LightMap LightSession::compute(const LightRequest& request, const CostOptions& cost,
                               const RunControl& control) const {
  if (request.method == Method::kWorld) return compute_world(request, cost, control);
  const Plan plan = this->plan(request);
  if (may_leave_trees_out(scene(1), request))
    if (auto map = near_trees_light(this->scene(threads_of(cost)), request, cost, control))
      return *std::move(map);
  const OpticsTable optics(forest_, request.optics), seen(forest_, plan.optics);
  const LightScene scene = this->scene(threads_of(cost));
  LightMap map;
  with_threads(cost.threads, [&] {
    const auto run = [&](const LightRequest& asked, std::span<const float> sunlit_fraction,
                         const RunControl& until) {
      return run_method(scene, seen, plan.light, with_bounces(asked, plan), sunlit_fraction, until);
    };
    map = request.method == Method::kAuto
              ? auto_light_map(scene, optics, plan.light, request, plan.sizes, run, control)
              : run(request, {}, control);
    if (bounces_skipped(plan)) take_true_optics(scene, optics, plan, map);
    if (request.probes && request.method != Method::kAuto)
      add_error_bars(scene, optics, plan.light, *request.probes, request.reference.ground, map, control);
    sign(map, scene, request, skip_notes(plan, map));
  });
  if (const std::string violation = find_violation(map, index_); !violation.empty())
    throw ContractViolation("the result of " + map.provenance.method + " holds " + violation);
  return request.selection.everything() ? map : selected(std::move(map), request);
}

LightMap LightSession::selected(LightMap whole, const LightRequest& request) const {
  const std::vector<std::uint32_t> instances = selected_instances(forest_, request.selection);
  LightMap map =
      selected_light(whole, index_, selected_forest(forest_, request.selection), instances, request.optics);
  map.provenance.settings.emplace_back("selection", std::to_string(instances.size()) + " of " +
                                                        std::to_string(forest_.instances.size()) + " trees");
  return map;
}

}  // namespace sunfleck
