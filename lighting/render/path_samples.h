// The numbers a path draws: the first dimensions low-discrepancy over the samples of one pass of a pixel
// (Owen-scrambled Sobol points, four dimensions at a time, every group shuffled by its own key so that groups
// are independent), the later ones plain random. They depend on (seed, pixel, pass, sample) alone.
#pragma once

#include <array>
#include <cstdint>

#include "sim/base/random.h"
#include "sim/base/vec.h"

namespace sunfleck {

class PathSamples {
 public:
  PathSamples(std::uint64_t seed, std::uint64_t pixel, std::uint32_t pass, std::uint32_t sample);
  std::array<double, 4> next();

 private:
  static constexpr std::uint32_t kEvenGroups = 9;  // the pixel and four bounces
  std::uint64_t key_;
  std::uint32_t sample_, group_ = 0;
  RandomStream random_;
};

}  // namespace sunfleck
