// Inside of EnvelopeQuery, shared by single answers and the whole light map.
#pragma once

#include <cmath>

#include "lighting/envelope/arriving_light.h"
#include "lighting/envelope/envelope_full.h"
#include "lighting/envelope/ground_light.h"
#include "lighting/envelope/leaf_answer.h"
#include "sim/base/contract.h"
#include "sim/base/parallel.h"

namespace sunfleck {

struct EnvelopeQuery::Parts {
  const Forest& forest;
  ForestIndex index;
  const OpticsTable& optics;
  const envelope::PreparedParts& prepared;
  envelope::Sources sources;

  double sun_depth(std::size_t element) const;
  std::vector<float> sun_depths(const RunControl& control) const;  // of all elements
  double sun_depth_at(const Vec3& point_m, std::span<const float> sectors) const;
  // `light` is scratch: one per thread.
  void element(std::size_t i, double sun_depth, envelope::ArrivingLight& light, EnvelopeAnswer& answer) const;

  // `albedo(band)` is that of the element itself.
  template <class Albedo>
  void fill(const envelope::ArrivingLight& light, const envelope::FaceWeights& weights, double sun_depth,
            const Albedo& albedo, EnvelopeAnswer& answer) const {
    const double seen = sources.sun ? std::exp(-sun_depth) : 0.0;
    answer.sunlit = seen * weights.own_sun;
    answer.recollision = light.recollision();
    answer.bands.resize(sources.bands.size());
    for (std::size_t b = 0; b < answer.bands.size(); ++b)
      answer.bands[b] = envelope::element_light(weights, light.bands()[b], prepared.set.count(),
                                                seen * sources.bands[b].beam_w_m2, albedo(b));
  }
};

namespace envelope {

// The prototype with the most leaf area in the forest: it stands for the foliage above the ground.
PrototypeId leafiest_prototype(const Forest& forest);
// True if any band has direct sunlight.
bool has_sun(const Illumination& light);

}  // namespace envelope

}  // namespace sunfleck
