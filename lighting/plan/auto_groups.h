// Errors of aggregates: of trees (mean irradiance or absorbed flux) and of height layers (mean irradiance).
//
// Groups are drawn evenly with repetition; of each a few elements, with a chance by their area, so that the
// plain mean of their errors is an unbiased estimate of the group's. Its square less its own variance (which
// holds the probes' noise) is an unbiased estimate of the group's squared error, and draws are independent:
// everything that holds for the error bar of elements holds for that of groups, one draw in place of a probe.
#pragma once

#include "lighting/optics/optics.h"
#include "lighting/plan/auto_probe.h"

namespace sunfleck {

// Which elements belong together.
struct ElementGroups {
  std::vector<std::uint32_t> element;  // by group
  std::vector<std::size_t> first;      // of each group in `element`, and the end
  std::vector<double> area_below_m2;   // running sum within the group, per entry of `element`
  std::size_t count() const { return first.size() - 1; }
  double area_m2(std::size_t group) const { return area_below_m2[first[group + 1] - 1]; }
};
// Of the measures kTreeRms, kTreeAbsorbedRms, kLayerRms; groups without elements or area are left out.
ElementGroups element_groups(const Forest& forest, const ForestIndex& index, const AutoOptions& options);

struct GroupProbes {
  ElementGroups groups;
  std::vector<std::uint32_t> group_of_draw;
  std::size_t per_draw = 0;
  ProbeSet probes;  // draw by draw
};
GroupProbes draw_group_probes(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
                              const ProbePlan& plan, const AutoOptions& options, const RunControl& control);

// One entry per draw; quantities as the measure says: W m-2, or W of a tree.
ErrorSample sample_group_error(const GroupProbes& drawn, const Forest& forest, const ForestIndex& index,
                               const OpticsTable& optics, const BandLightMap& map, std::size_t band,
                               AutoMeasure measure);

bool is_of_groups(AutoMeasure measure);

}  // namespace sunfleck
