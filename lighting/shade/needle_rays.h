// A bough needle by needle, and exact rays through it: the truth that closed forms are measured against, and
// a source for baked tables (bough_table.h). No acceleration beyond the whorls' heights; a few microseconds
// per ray. Needles are solid cylinders with flat ends; every whorl has its needles evenly round the axis from
// a random phase.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lighting/shade/bough.h"
#include "sim/base/run_control.h"

namespace sunfleck {

struct NeedleHit {
  double distance = 0;
  Vec3 normal{0};  // unit, outwards
};

class NeedleRays {
 public:
  // `bough.cones` whorls (>= 1), phases from the seed.
  NeedleRays(const Bough& bough, std::uint64_t seed);

  std::optional<NeedleHit> closest_hit(const Vec3& origin, const Vec3& direction, double min_distance) const;
  bool occluded(const Vec3& origin, const Vec3& direction, double min_distance) const;
  const Bough& bough() const { return bough_; }

 private:
  struct WhorlRange {
    int first = 0, last = -1;
  };
  WhorlRange whorls(const Vec3& origin, const Vec3& direction) const;

  Bough bough_;
  std::vector<Vec3> axis_;  // unit, whorl by whorl
};

struct TracedBough {
  double opacity = 0, opacity_se = 0;      // mean over the rays and its standard error
  double reflected = 0, reflected_se = 0;  // of max(N.L, 0) where lit
};

// Mean over a strip |x| < half_width across the view, over the middle whorls of `needles` (those that rays at
// these angles see as endless; throws Error(kInvalidInput) if there are too few). Standard errors come
// from 20 groups of rays. Same bytes for any number of threads.
TracedBough trace_bough_strip(const NeedleRays& needles, double half_width, const Vec3& to_viewer,
                              const Vec3& to_light, int rays, std::uint64_t seed,
                              const RunControl& control = {});

}  // namespace sunfleck
