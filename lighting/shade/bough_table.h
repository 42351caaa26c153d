// Opacity and reflected light of a far bough (a strip of an endless one, or whatever the source computes)
// over all directions of viewer and light, looked up instead of computed: about 20 ns. For boughs below a
// pixel, where only the mean over the strip shows; half a table of 13^3 entries is 9 kB per kind of bough.
//
// Filled from any source of truth: the closed form (bough_strip) or rays through needles (trace_bough_strip).
#pragma once

#include <functional>
#include <vector>

#include "lighting/shade/bough_light.h"
#include "sim/base/run_control.h"

namespace sunfleck {

class BoughTable {
 public:
  // Directions are sampled at `rows` zenith angles (midpoints of equal steps over 0 .. pi) for viewer and
  // light and `rows` azimuths between them over 0 .. pi (ends included). `source` is called once per entry,
  // from many threads, and must not depend on the order. Throws Error(kInvalidInput) for rows outside 2
  // .. 64.
  using Source = std::function<BoughLight(const Vec3& to_viewer, const Vec3& to_light)>;
  BoughTable(int rows, const Source& source, const RunControl& control = {});

  // Unit vectors in the bough's frame. Interpolated linearly in the angles.
  BoughLight at(const Vec3& to_viewer, const Vec3& to_light) const;
  std::size_t memory_bytes() const { return sizeof(float) * (opacity_.size() + reflected_.size()); }

 private:
  int rows_;
  std::vector<float> opacity_;    // [view zenith]
  std::vector<float> reflected_;  // [view zenith][light zenith][azimuth]
};

}  // namespace sunfleck
