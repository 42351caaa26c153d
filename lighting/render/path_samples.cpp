#include "lighting/render/path_samples.h"

#include "lighting/trace/low_discrepancy.h"

namespace sunfleck {
namespace {

// Aligned blocks of 2^k consecutive numbers go to such blocks, which are as evenly spread as the first one.
std::uint32_t shuffled(std::uint32_t index, std::uint32_t key) { return trace::owen_scramble(index, key); }

}  // namespace

PathSamples::PathSamples(std::uint64_t seed, std::uint64_t pixel, std::uint32_t pass, std::uint32_t sample)
    : key_(mix_seed(mix_seed(seed, pixel), pass)),
      sample_(sample),
      random_(key_, sample, RandomPurpose::kCamera) {}

std::array<double, 4> PathSamples::next() {
  if (group_ < kEvenGroups) {
    const std::uint64_t key = mix_seed(key_, ++group_);
    const auto point = trace::ScrambledPoints(key)(shuffled(sample_, static_cast<std::uint32_t>(key >> 32)));
    return {point[0], point[1], point[2], point[3]};
  }
  return {random_.uniform(), random_.uniform(), random_.uniform(), random_.uniform()};
}

}  // namespace sunfleck
