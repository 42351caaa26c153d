// Running means of the pixels of a picture over its units of sampling: a unit is one sample, or one pass of
// low-discrepancy samples that is independent of all others, so that the spread of units tells the error.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/vec.h"

namespace sunfleck {

class Film {
 public:
  explicit Film(std::size_t pixels) : mean_(pixels, Vec3(0.0)), squares_(pixels, 0.0), units_(pixels, 0) {}

  // One more unit. Different pixels may be written by different threads.
  void add(std::size_t pixel, const Vec3& value);
  Vec3 mean(std::size_t pixel) const { return mean_[pixel]; }
  std::uint32_t units(std::size_t pixel) const { return units_[pixel]; }
  // Of the mean of the three channels; 0 with one unit, which tells nothing of its error.
  double standard_error(std::size_t pixel) const;

 private:
  std::vector<Vec3> mean_;
  std::vector<double> squares_;  // of the channels' mean, by updates (Welford 1962)
  std::vector<std::uint32_t> units_;
};

}  // namespace sunfleck
