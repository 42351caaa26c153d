// Which representation of a plant a picture takes at a pixel footprint: the cheapest whose measured error is
// within the picture's tolerance.
//
// Footprints count in sides of the plant's leaves (leaf_side_m): how far leaves are below a pixel is what
// errors depend on, so that one table serves all species.
//
// The choice is a plain function of a table of measurements, one row per representation and footprint;
// nothing is assumed of the representations themselves. Between rows of one representation error and cost are
// interpolated over the logarithm of the footprint; finer than its finest row a representation is not used
// (nothing was measured there), coarser than its coarsest row that row holds. The explicit plant is always
// allowed. One number per instance (or sample) shifts the footprint by up to 40 % to the fine side, so that
// representations replace each other instance by instance, never all at once, and never beyond the tolerance.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/plant/prototype.h"

namespace sunfleck {

enum class Detail : std::uint8_t {
  kExplicit,  // every leaf or needle
  kPruned4,   // a quarter of the leaves, enlarged (prune.h)
  kPruned16,
  kPruned64,
  kBough,      // closed form of boughs or shoots (bough_light.h)
  kBillboards  // billboard cloud (billboard_cloud.h)
};
inline constexpr int kDetails = 6;
// "explicit", "pruned_4", "pruned_16", "pruned_64", "bough", "billboards".
std::string to_string(Detail detail);

struct MeasuredDetail {
  Detail detail = Detail::kExplicit;
  double footprint = 1;  // pixel's width at the plant in leaf sides, > 0
  double rms_error = 0;  // of radiance, in units of the picture's white
  double cost_ns = 0;    // per sample, shadow included
};

enum class LightUse {
  kPicture,
  kLightMap  // values that are relied on: always explicit
};

class DetailTable {
 public:
  // Rows in any order. Throws Error(kInvalidInput) naming the row for a footprint <= 0, a negative or
  // undefined error or cost, or two rows of one representation at one footprint.
  explicit DetailTable(std::vector<MeasuredDetail> rows);

  // uniform in [0, 1): the same for all rays of an instance (or of a sample). Explicit costs what its rows
  // say, or counts as dearest if there are none.
  Detail choose(double footprint, double rms_tolerance, double uniform,
                LightUse use = LightUse::kPicture) const;
  // Expected error and cost of a representation; infinite where it was not measured.
  MeasuredDetail at(Detail detail, double footprint) const;

 private:
  std::vector<MeasuredDetail> rows_;  // by representation, then footprint
};

// Side of the square that stands for the leaves of a plant: its area is the mean of their outlines weighted
// by their areas (few large leaves are coarser than many small ones). Of a shoot the outline from its side. 0
// without leaves.
double leaf_side_m(std::span<const FoliageElement> foliage);

// A number in [0, 1) of an instance that does not depend on how many others there are.
double detail_choice(std::uint64_t seed, std::uint64_t instance);

}  // namespace sunfleck
