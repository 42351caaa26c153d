// What both ways of `auto` share (by tolerance, by time): the probes, the rungs that were tried, the best of
// them so far, and the answer made of it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lighting/plan/auto_attempt.h"
#include "lighting/plan/auto_method.h"
#include "lighting/plan/auto_rungs.h"
#include "lighting/trace/sun_raster.h"

namespace sunfleck {

class AutoRun {
 public:
  // All must outlive it.
  AutoRun(const LightScene& scene, const OpticsTable& optics, const Illumination& light,
          const LightRequest& request, const SceneSizes& sizes, const MethodRunner& run);

  // Draws the probes (and those of groups, where the measure has any); comes first.
  void probe(const ProbePlan& plan, const RunControl& control);
  // Runs, corrects and measures a rung, and keeps it if it is the best so far. True if it is within the
  // tolerance. Throws what the method throws.
  bool attempt(const Rung& rung, const RunControl& control);
  // True, once, if the error of the best so far may be within the tolerance but too few probes were drawn to
  // tell. look_again() then judges it by four times as many, which is cheaper than a rung that costs ten
  // times as much: true if it is within.
  bool may_look_again() const;
  bool look_again(const RunControl& control);
  bool has_answer() const { return best_.has_value(); }
  // Of the last attempt, in the tolerance's measure.
  double last_error() const { return last_error_; }
  void note(std::string text) { notes_.push_back(std::move(text)); }
  // The best, with what was tried and measured in its provenance.
  LightMap answer();

  const LightScene& scene() const { return scene_; }
  const LightRequest& request() const { return request_; }
  const AutoOptions& options() const { return request_.automatic; }
  const SceneSizes& sizes() const { return sizes_; }
  const LightSpread& spread() const { return spread_; }
  std::size_t bands() const { return optics_.band_count(); }
  bool has_sun() const { return has_sun_; }
  bool is_of_elements() const { return options().measure == AutoMeasure::kElementRms; }

 private:
  LightMap run(const Rung& rung, const RunControl& control);
  std::span<const float> drawn_sun(double error, const RunControl& control);
  bool may_not_fit(const GridOptions& grid) const;
  LightRequest asked_of(const Rung& rung) const;
  std::vector<CorrectionForm> corrections_of(const Rung& rung) const;
  void measure_close_cover(const RunControl& control);
  bool take(Attempt attempt);
  Judge judge() const;
  bool may_be_within(const Attempt& attempt) const;
  void draw_more_probes(const RunControl& control);
  void describe(LightMap& map) const;

  const LightScene& scene_;
  const OpticsTable& optics_;
  const Illumination& light_;
  const LightRequest& request_;
  const MethodRunner& run_;
  const SceneSizes& sizes_;
  const bool has_sun_;
  ProbePlan plan_;
  std::unique_ptr<ProbeScene> rays_;
  ProbeSet probes_;
  bool looked_again_ = false;
  std::optional<GroupProbes> groups_;
  LightSpread spread_;
  std::shared_ptr<const SunExposure> exposure_;
  double exposure_pixel_m_ = 0;
  std::shared_ptr<const std::vector<float>> close_cover_;
  Provenance times_;  // of all attempts
  std::optional<Attempt> best_;
  double last_error_ = 0;
  std::string tried_;
  std::vector<std::string> notes_;
};

}  // namespace sunfleck
