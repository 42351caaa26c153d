// Counter-based random numbers: the value depends only on (seed, element, purpose, counter), never on the
// order or the thread in which it is drawn. Philox4x32-10 of Salmon et al. 2011, "Parallel random numbers: as
// easy as 1, 2, 3".
#pragma once

#include <array>
#include <cstdint>

namespace sunfleck {

// The ten-round Philox 4x32 block function; checked against the published known answers.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

// What a stream is drawn for: two purposes never share numbers. Add a line here for a new use.
enum class RandomPurpose : std::uint32_t {
  kLsystem = 1,
  kCrownFill,
  kPlanting,
  kRaysFront,
  kRaysBack,
  kRaysWood,
  kRaysGround,
  kSunRays,
  kFreeFlight,
  kCamera,
  kTestScene,
  kProbeDraw,
  kProbePaths,
  kProbeSun,
  kProbeResampling,
  kSunRaster = 16,
  kStandRays = 20,
  kStandBounces,
  kSensorRays,
  kNeedlePhases = 60,
  kShadowMask,
  kLeafPruning,
  kDetailChoice,
  kBillboards,
  kWoodThinning = 66,
  kSurroundings = 40,
  kClumps,
  kCrownBranches,
  kUnderstorey,
  kSplitHalf,
  kNeedles = 60
};

// One stream of numbers: (seed, element, purpose) names it, next() walks it. Cheap to make, copy and skip.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t element, RandomPurpose purpose,
               std::uint32_t skip_blocks = 0);

  std::uint32_t next_u32();
  double uniform();                      // [0, 1), 32 bits
  double uniform(double lo, double hi);  // [lo, hi)
  double normal();                       // mean 0, variance 1
  std::uint32_t below(std::uint32_t n);  // 0 .. n-1

 private:
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
};

// A 64-bit hash of two numbers (SplitMix64 finaliser), for seeds of parts from the seed of the whole.
std::uint64_t mix_seed(std::uint64_t seed, std::uint64_t part);

}  // namespace sunfleck
