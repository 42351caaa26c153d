// A scene whose true light is known, and how often error bars of cheap answers hold their true error. The
// truth is the reference on leaves cut into nine, with rays enough that its own error is a small part of an
// interval.
#pragma once

#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "lighting/plan/auto_groups.h"
#include "lighting/plan/auto_probe.h"
#include "tests/lighting/plan/auto_scenes.h"

namespace sunfleck::test {

inline constexpr int kTruthRays = 128;  // per piece
inline constexpr int kCuts = 3;

struct TrueLight {
  std::vector<double> irradiance_w_m2, variance_w2_m4;  // per leaf
  double mean_w_m2 = 0, area_mean_w_m2 = 0, area_mean_error_w_m2 = 0;
};

inline Forest cut_up(Forest forest) {
  for (Prototype& prototype : forest.prototypes) {
    std::vector<FoliageElement> pieces;
    for (const FoliageElement& e : prototype.foliage)
      for (int k = 0; k < kCuts * kCuts; ++k) {
        FoliageElement piece = e;
        piece.half_u_m /= float{kCuts};
        piece.half_v_m /= float{kCuts};
        piece.centre_m += static_cast<float>(2 * (k % kCuts) + 1 - kCuts) * piece.half_u_m +
                          static_cast<float>(2 * (k / kCuts) + 1 - kCuts) * piece.half_v_m;
        piece.area_m2 /= float{kCuts * kCuts};
        pieces.push_back(piece);
      }
    prototype.foliage = std::move(pieces);
  }
  return forest;
}

inline TrueLight true_light(const BandLightMap& pieces) {
  constexpr double kPieces = kCuts * kCuts;
  const std::size_t leaves = pieces.elements.size() / (kCuts * kCuts);
  TrueLight light{std::vector<double>(leaves), std::vector<double>(leaves), mean_total_w_m2(pieces),
                  pieces.mean_irradiance_w_m2, pieces.mean_irradiance_standard_error_w_m2};
  for (std::size_t i = 0; i < pieces.elements.size(); ++i) {
    light.irradiance_w_m2[i / (kCuts * kCuts)] += parts_of(pieces.elements[i]).total() / kPieces;
    light.variance_w2_m4[i / (kCuts * kCuts)] += std::pow(pieces.standard_error_w_m2[i] / kPieces, 2);
  }
  return light;
}

struct TrueError {
  double bias = 0, element_rms = 0;
};

// The definitions of auto_probe.h over all elements, the truth's noise taken out.
inline TrueError true_error(const BandLightMap& map, const TrueLight& truth) {
  double squares = 0;
  for (std::size_t i = 0; i < map.elements.size(); ++i) {
    const double d = parts_of(map.elements[i]).total() - truth.irradiance_w_m2[i];
    squares += d * d - truth.variance_w2_m4[i];
  }
  const auto n = static_cast<double>(map.elements.size());
  return {(map.mean_irradiance_w_m2 - truth.area_mean_w_m2) / truth.area_mean_w_m2,
          std::sqrt(std::max(0.0, squares / n)) / truth.mean_w_m2};
}

// RMS over groups of the error of their area-weighted mean, relative to the true mean over groups.
inline double true_group_rms(const ElementGroups& groups, const BandLightMap& map, const TrueLight& truth) {
  double squares = 0, means = 0;
  for (std::size_t g = 0; g < groups.count(); ++g) {
    double error = 0, mean = 0, below = 0;
    for (std::size_t k = groups.first[g]; k < groups.first[g + 1]; ++k) {
      const std::size_t e = groups.element[k];
      const double share = (groups.area_below_m2[k] - below) / groups.area_m2(g);
      below = groups.area_below_m2[k];
      error += share * (parts_of(map.elements[e]).total() - truth.irradiance_w_m2[e]);
      mean += share * truth.irradiance_w_m2[e];
    }
    squares += error * error;
    means += mean;
  }
  const auto n = static_cast<double>(groups.count());
  return std::sqrt(squares / n) / (means / n);
}

struct Coverage {
  int inside_bias = 0, inside_rms = 0, bars = 0;
  double bias_width = 0, rms_width = 0;
  void add(const ErrorBar& bar, const TrueError& truth) {
    inside_bias += bar.bias.low <= truth.bias && truth.bias <= bar.bias.high;
    inside_rms += bar.element_rms.low <= truth.element_rms && truth.element_rms <= bar.element_rms.high;
    bias_width += bar.bias.high - bar.bias.low;
    rms_width += bar.element_rms.high - bar.element_rms.low;
    ++bars;
  }
  void add(const Coverage& other) {
    inside_bias += other.inside_bias;
    inside_rms += other.inside_rms;
    bars += other.bars;
  }
};

class CoveredScene {
 public:
  explicit CoveredScene(const Forest& forest)
      : forest_(forest), request_(sun_and_sky(Method::kReference)), optics_(forest, request_.optics) {
    request_.reference.rays_per_face = request_.reference.sun_rays_per_element = kTruthRays;
    request_.reference.ground_cell_m = 0.1;
    for (const BandLightMap& band : compute_light_map(cut_up(forest), request_, {}, {}).bands)
      truth_.push_back(true_light(band));
    for (const Method method : {Method::kEnvelopeMarched, Method::kSppG}) {
      LightRequest asked = request_;
      asked.method = method;
      maps_.push_back(compute_light_map(forest, asked, {}, {}));
    }
  }

  Coverage count(const ProbePlan& plan_of_all, int seeds) const {
    const ProbeScene scene(forest_, true, {});
    const Illumination light = checked(request_.light, 2);
    Coverage coverage;
    for (int seed = 1; seed <= seeds; ++seed) {
      ProbePlan plan = plan_of_all;
      plan.seed = static_cast<std::uint64_t>(seed);
      const ProbeSet probes = draw_probes(scene, optics_, light, plan, {});
      const Resamples resamples(probes.probes.size(), plan.seed);
      for (const LightMap& map : maps_)
        for (std::size_t b = 0; b < 2; ++b)
          coverage.add(error_bar(sample_error(probes, map.bands[b], b), resamples),
                       true_error(map.bands[b], truth_[b]));
    }
    return coverage;
  }

  // Bars of trees, or of layers where there is one tree.
  std::pair<int, int> count_groups(int seeds) const {
    AutoOptions options;
    options.measure = forest_.instances.size() > 1 ? AutoMeasure::kTreeRms : AutoMeasure::kLayerRms;
    options.layers = 5;
    const ProbeScene scene(forest_, true, {});
    const ForestIndex index(forest_);
    const Illumination light = checked(request_.light, 2);
    int inside = 0, bars = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const ProbePlan plan{.seed = static_cast<std::uint64_t>(seed)};
      const GroupProbes drawn = draw_group_probes(scene, optics_, light, plan, options, {});
      const Resamples resamples(drawn.group_of_draw.size(), plan.seed);
      for (const LightMap& map : maps_)
        for (std::size_t b = 0; b < 2; ++b, ++bars) {
          const ErrorSample sample =
              sample_group_error(drawn, forest_, index, optics_, map.bands[b], b, options.measure);
          const Interval bar = error_bar(sample, resamples).element_rms;
          const double truth = true_group_rms(drawn.groups, map.bands[b], truth_[b]);
          inside += bar.low <= truth && truth <= bar.high;
        }
    }
    return {inside, bars};
  }

  double truth_noise() const { return truth_[0].area_mean_error_w_m2 / truth_[0].area_mean_w_m2; }

 private:
  const Forest& forest_;
  LightRequest request_;
  OpticsTable optics_;
  std::vector<TrueLight> truth_;  // per band
  std::vector<LightMap> maps_;
};

}  // namespace sunfleck::test
