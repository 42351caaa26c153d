// What a request needs and what it does not, decided before any work: every skip with its reason and a bound
// on what it can change, and what the work will cost. Skips take sources, bounces or optics away from what
// the estimators see, so that they hold for every method alike. LightRequest::skip = kNever computes
// everything but light that is 0.
//
// Bounds. E0 = beam + diffuse horizontal irradiance is the most that sun and sky put on a face; a, the
// largest albedo of leaves (r + t), bark and soil, is the most that any surface gives back of what falls on
// it. So no face gets more than E = E0 / (1 - a), and none gives back more than a E; bounces after the first
// bring no face more than a^2 E / (1 - a) (1 - a) = a^2 E0 / (1 - a). An element has two faces.
//
//   no bounces        a < 0.02            2 a E0 / (1 - a)
//   one bounce        a < 0.1             2 a^2 E0 / (1 - a): the rest of the series is estimated by the
//                                         methods from the first two terms, with a factor of at most
//                                         1 / (1 - a), which is no farther from the truth than leaving it out
//   no leaf bounces   p < 0.05            2 (p + soil albedo) a_leaf E, p the largest share of a face's view
//                                         that other leaves and wood may fill: the sum of area / (pi
//                                         distance^2) over all others, at most 1 each. The ground, which is
//                                         flat, gives back at most its albedo of what leaves put on it.
#pragma once

#include <string>
#include <vector>

#include "lighting/plan/auto_cost.h"
#include "lighting/plan/light_request.h"

namespace sunfleck {

struct PlannedSkip {
  std::string what, reason;
  std::vector<double> bound_w_m2;  // per band, of an element's front + back irradiance
};

struct Plan {
  Method method = Method::kReference;
  std::vector<std::string> does;  // what will be done, in words
  std::vector<PlannedSkip> skips;
  // What the estimators see: sources and optics without what is skipped.
  Illumination light;
  OpticsRequest optics;
  bool one_bounce = false;
  SceneSizes sizes;
  double predicted_s = 0;      // of one core, within a factor of about 2
  double predicted_bytes = 0;  // at most, beside the forest
};

// Checks everything that can be checked before work. Throws Error(kInvalidInput) naming the field, or
// kLimitExceeded for a grid or stored hits that do not fit in memory.
Plan make_plan(const Forest& forest, const ForestIndex& index, const LightRequest& request);

// Bounds relative to the means of the finished map, the largest over the bands.
std::vector<SkipNote> skip_notes(const Plan& plan, const LightMap& map);

// Largest share of a face's view that other foliage and wood may fill, as above; nothing for forests of more
// than `most` elements and wood, or periodic ones.
std::optional<double> largest_view_of_others(const Forest& forest, const ForestIndex& index,
                                             std::size_t most = 2000);

// Bytes needed beside the forest at most, from the sizes alone.
double predicted_bytes(const LightRequest& request, double elements, double wood_faces, double cells);

}  // namespace sunfleck
