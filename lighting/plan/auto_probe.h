// The error bar of any light map: random elements, their true light by probes, and from the differences the
// bias and the RMS error with 95 % intervals.
//
// Elements are drawn evenly over the foliage elements, with repetition, so that probes are independent. The
// RMS is one per element; the bias is that of the area-weighted mean (as BandLightMap's), each probe weighing
// as its area. Both are relative to the true mean, taken as the map's mean minus the mean difference. The
// probes' own noise is taken out of the RMS. Errors confined to less than about one element in a hundred can
// escape two hundred probes.
#pragma once

#include <string>
#include <vector>

#include "lighting/base/light_map.h"
#include "lighting/plan/auto_interval.h"
#include "lighting/plan/auto_options.h"
#include "lighting/trace/probe_light.h"

namespace sunfleck {

// Light on both faces of an element together, by its last way.
struct LightParts {
  double direct_w_m2 = 0, sky_w_m2 = 0, scattered_w_m2 = 0;
  double sunlit = 0;  // fraction
  double close = 0;   // of the view of both faces, filled by the closest leaves: lighting/depth/close_cover.h
  double diffuse() const { return sky_w_m2 + scattered_w_m2; }
  double total() const { return direct_w_m2 + diffuse(); }
};
LightParts parts_of(const ElementLight& light, double sunlit_fraction = 0, double close_cover = 0);
LightParts parts_of(const ProbeBand& light);

struct ProbeSet {
  std::vector<ProbeLight> probes;
  std::vector<double> area_m2;  // of each probe's element
};
ProbeSet draw_probes(const ProbeScene& scene, const OpticsTable& optics, const Illumination& light,
                     const ProbePlan& plan, const RunControl& control);

// What an error bar of one band is made from.
struct ErrorSample {
  std::vector<double> difference_w_m2;  // estimate - probe
  std::vector<double> variance_w2_m4;   // of the probe
  std::vector<double> area_m2;
  double mean_w_m2 = 0;       // of the estimate over all elements
  double area_mean_w_m2 = 0;  // the same, weighted by area
};
ErrorSample sample_error(const ProbeSet& probes, const BandLightMap& map, std::size_t band);
// The same for light at the probes that is not (yet) that of the map.
ErrorSample sample_error(const ProbeSet& probes, const std::vector<LightParts>& estimate,
                         const BandLightMap& map, std::size_t band);

struct ErrorBar {
  Interval bias, element_rms;           // relative
  double mean_standard_error_w_m2 = 0;  // of the area-weighted mean: bias and its uncertainty together
};
ErrorBar error_bar(const ErrorSample& sample, const Resamples& resamples);

// Without intervals.
struct PointError {
  Figure bias;
  double element_rms = 0;
  double resolution = 0;  // the smallest RMS that the probes tell from 0, at 1.96 standard errors
};
PointError point_error(const ErrorSample& sample);

double mean_total_w_m2(const BandLightMap& map);  // over elements, unweighted

}  // namespace sunfleck
