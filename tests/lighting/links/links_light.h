// The links method on the small scenes of the traced reference's tests.
#pragma once

#include <cmath>

#include "lighting/base/summaries.h"
#include "lighting/links/links_estimator.h"
#include "tests/lighting/trace/scenes.h"

namespace sunfleck::test {

inline LightMap links_light(const Forest& forest, double soil_albedo, const Illumination& light,
                            const LinksOptions& options = {}) {
  return links_light_map(forest, optics_of(forest, soil_albedo), light, options, {});
}

inline double received(const ElementLight& e) {
  return static_cast<double>(e.front.total()) + e.back.total();
}
inline double diffuse(const ElementLight& e) {
  return static_cast<double>(e.front.sky_w_m2) + e.front.scattered_w_m2 + e.back.sky_w_m2 +
         e.back.scattered_w_m2;
}

// RMS of the differences of `value` over the mean of b.
template <class Value>
double relative_rms(const LightMap& a, const LightMap& b, Value&& value) {
  double squares = 0.0, mean = 0.0;
  const auto &x = a.bands[0].elements, &y = b.bands[0].elements;
  for (std::size_t i = 0; i < y.size(); ++i) {
    squares += std::pow(value(x[i]) - value(y[i]), 2);
    mean += value(y[i]);
  }
  return std::sqrt(squares * static_cast<double>(y.size())) / mean;
}

inline Forest small_crown(std::size_t leaves = 600, const Leaf& leaf = {0.45, 0.45}) {
  return forest_of(random_leaves(Crown::kSphere, {0, 0, 1.6}, Vec3(1), leaves, 0.15, 5), {leaf});
}

}  // namespace sunfleck::test
