#include "lighting/plan/auto_run.h"

#include "lighting/base/summaries.h"
#include "lighting/depth/close_cover.h"
#include "lighting/plan/auto_direct.h"
#include "lighting/plan/auto_report.h"
#include "lighting/trace/probe_path.h"
#include "lighting/transport/grid_limits.h"
#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {
namespace {

// 0: as many as its own standard errors ask for to meet the tolerance.
void set_rays(LightRequest& asked, int rays) {
  constexpr int kFirstRays = 16;
  asked.method = Method::kReference;
  ReferenceOptions& o = asked.reference;
  o.rays_per_face = o.sun_rays_per_element = rays > 0 ? rays : kFirstRays;
  if (rays > 0)
    o.target_relative_error = 0.0;
  else if (asked.automatic.measure == AutoMeasure::kElementRms)
    o.target_relative_error = 0.9 * asked.automatic.aim();
}

}  // namespace

AutoRun::AutoRun(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
                 const LightRequest& request, const SceneSizes& sizes, const MethodRunner& run)
    : scene_(scene),
      optics_(optics),
      light_(light),
      request_(request),
      run_(run),
      sizes_(sizes),
      has_sun_(trace::has_beam(light)) {}

void AutoRun::probe(const ProbePlan& plan, const RunControl& control) {
  plan_ = plan;
  {
    const StageTimer timer(times_, "building ray scene");
    rays_ = std::make_unique<ProbeScene>(trace::KeptRays(scene_.forest, scene_.store, control),
                                         request_.reference.ground);
  }
  const StageTimer timer(times_, "probing");
  probes_ = draw_probes(*rays_, optics_, light_, plan_, control);
  if (is_of_groups(options().measure))
    groups_ = draw_group_probes(*rays_, optics_, light_, plan_, options(), control);
  spread_ = light_spread(probes_, bands());
}

bool AutoRun::attempt(const Rung& rung, const RunControl& control) {
  SUNFLECK_EXPECTS(!probes_.probes.empty());
  LightMap map = run(rung, control);
  measure_close_cover(control);
  return take(judge().judge(rung.name(), std::move(map), corrections_of(rung)));
}

Judge AutoRun::judge() const {
  return {scene_.forest,
          scene_.index,
          optics_,
          probes_,
          groups_ ? &*groups_ : nullptr,
          options(),
          close_cover_ ? std::span<const float>(*close_cover_) : std::span<const float>{}};
}

void AutoRun::measure_close_cover(const RunControl& control) {
  if (close_cover_) return;
  const StageTimer timer(times_, "closest leaves");
  close_cover_ = scene_.store.get<std::vector<float>>(
      PreparedKey("close cover"), control,
      [&] { return std::make_shared<const std::vector<float>>(close_cover(scene_.forest, control)); },
      [](const std::vector<float>& cover) { return cover.size() * sizeof(float); });
}

// Two standard errors of the mean square down from what was measured.
bool AutoRun::may_be_within(const Attempt& attempt) const {
  for (const JudgedBand& band : attempt.bands) {
    const PointError error = point_error(band.sample);
    const double square = error.element_rms * error.element_rms;
    if (square - error.resolution * error.resolution > options().aim() * options().aim()) return false;
  }
  return true;
}

void AutoRun::draw_more_probes(const RunControl& control) {
  constexpr int kTimesMore = 3;
  const StageTimer timer(times_, "probing");
  ProbePlan more = plan_;
  more.seed = mix_seed(plan_.seed, 2);
  more.count = kTimesMore * plan_.count;
  const ProbeSet drawn = draw_probes(*rays_, optics_, light_, more, control);
  probes_.probes.insert(probes_.probes.end(), drawn.probes.begin(), drawn.probes.end());
  probes_.area_m2.insert(probes_.area_m2.end(), drawn.area_m2.begin(), drawn.area_m2.end());
  plan_.count += more.count;
}

bool AutoRun::may_look_again() const {
  return !looked_again_ && best_ && is_of_elements() && may_be_within(*best_);
}

// The corrections stay: they were fitted to a quarter of the probes that judge them now.
bool AutoRun::look_again(const RunControl& control) {
  SUNFLECK_EXPECTS(may_look_again());
  looked_again_ = true;
  draw_more_probes(control);
  Attempt again = judge().judge(best_->name + " again", std::move(best_->map), {});
  for (std::size_t b = 0; b < again.bands.size(); ++b) again.bands[b].correction = best_->bands[b].correction;
  const std::string name = std::move(best_->name);
  best_.reset();
  const bool tolerable = take(std::move(again));
  best_->name = name;
  return tolerable;
}

LightMap AutoRun::run(const Rung& rung, const RunControl& control) {
  const bool drawn = has_sun_ && (rung.kind == RungKind::kDrawnGrid || rung.kind == RungKind::kLinks);
  const std::span<const float> sunlit = drawn ? drawn_sun(rung.sun_error, control) : std::span<const float>{};
  LightMap map = run_(asked_of(rung), sunlit, control);
  auto& times = map.provenance.times;
  times_.times.insert(times_.times.end(), times.begin(), times.end());
  times.clear();
  return map;
}

// One point of the sun's disc: what that leaves out of penumbras the probes see, and a finer rung or the
// reference mends. A picture that is fine enough is used again.
std::span<const float> AutoRun::drawn_sun(double error, const RunControl& control) {
  const double pixel_m = sun_pixel_sides(spread_, error) * sizes_.leaf_side_m;
  if (!exposure_ || exposure_pixel_m_ > 1.001 * pixel_m) {
    const StageTimer timer(times_, "drawing sun");
    exposure_ = sun_exposure(scene_, light_,
                             {.pixel_m = pixel_m,
                              .sun_directions = 1,
                              .ground = request_.reference.ground,
                              .seed = request_.reference.seed},
                             control);
    exposure_pixel_m_ = pixel_m;
  }
  return exposure_->sunlit_fraction;
}

// The check looks at every leaf: not where the cells are far below the limit.
bool AutoRun::may_not_fit(const GridOptions& grid) const {
  const auto cells = static_cast<std::uint64_t>(cells_of_grid(sizes_, grid.cell_m));
  const auto elements = static_cast<std::uint64_t>(sizes_.elements);
  return grid_bytes(cells, elements, grid.directions) > grid.memory_limit_bytes / 4 &&
         !grid_suitability(scene_.forest, grid).fits;
}

LightRequest AutoRun::asked_of(const Rung& rung) const {
  LightRequest asked = request_;
  switch (rung.kind) {
    case RungKind::kGrid:
    case RungKind::kDrawnGrid:
      asked.method = Method::kGrid;
      asked.grid = rung.grid;
      // Cells that nobody asked for and that do not fit the memory become those that do.
      if (request_.grid.cell_m == 0.0 && may_not_fit(rung.grid)) asked.grid.cell_m = 0.0;
      break;
    case RungKind::kLinks:
      asked.method = Method::kLinks;
      asked.links.links_per_face = rung.rays;
      asked.links.ground = request_.reference.ground;
      break;
    case RungKind::kReference:
      set_rays(asked, rung.rays);
      break;
  }
  return asked;
}

std::vector<CorrectionForm> AutoRun::corrections_of(const Rung& rung) const {
  if (rung.kind == RungKind::kReference) return {};
  if (rung.kind == RungKind::kGrid && has_sun_) return {CorrectionForm::kTotal, CorrectionForm::kParts};
  return {CorrectionForm::kDiffuse, CorrectionForm::kDiffuseParts, CorrectionForm::kDiffuseBySun,
          CorrectionForm::kDiffuseByClose, CorrectionForm::kDiffuseBySunAndClose};
}

// Keeps the better attempt; true if it will do.
bool AutoRun::take(Attempt attempt) {
  tried_ += (tried_.empty() ? "" : "; ") + attempt.name + " " + short_number(attempt.worst_error);
  last_error_ = attempt.worst_error;
  const bool tolerable = attempt.tolerable;
  if (!best_ || tolerable || attempt.worst_error < best_->worst_error) best_ = std::move(attempt);
  return tolerable;
}

LightMap AutoRun::answer() {
  SUNFLECK_EXPECTS(best_.has_value());
  LightMap map = std::move(best_->map);
  Provenance& p = map.provenance;
  {
    const StageTimer timer(times_, "error bars");
    describe(map);
  }
  p.times = std::move(times_.times);
  p.notes.insert(p.notes.end(), notes_.begin(), notes_.end());
  if (!options().time_s && !best_->tolerable)
    p.notes.push_back("tolerance " + short_number(options().aim()) + " of " + to_string(options().measure) +
                      " not reached: measured " + short_number(best_->worst_error));
  return map;
}

void AutoRun::describe(LightMap& map) const {
  Provenance& p = map.provenance;
  if (options().time_s)
    p.settings.emplace_back("time_s", short_number(*options().time_s));
  else
    p.settings.emplace_back("tolerance", short_number(options().aim()));
  p.settings.emplace_back("tolerance_measure", to_string(options().measure));
  p.settings.emplace_back("chosen_method", best_->name);
  p.settings.emplace_back("tried_methods", tried_);
  add_probe_settings(plan_, p);
  const Resamples resamples(probes_.probes.size(), plan_.seed);
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    const JudgedBand& judged = best_->bands[b];
    if (judged.correction)
      p.settings.emplace_back("correction." + map.bands[b].band, to_text(*judged.correction));
    add_error_bar(judged.sample, resamples, map.bands[b], p);
    if (judged.group) add_group_bar(*judged.group, options().measure, plan_.seed, map.bands[b].band, p);
  }
}

}  // namespace sunfleck
