#include "lighting/plan/auto_interval.h"

#include <algorithm>
#include <numeric>

#include "sim/base/contract.h"
#include "sim/base/random.h"

namespace sunfleck {

Resamples::Resamples(std::size_t probes, std::uint64_t seed) : probes_(probes), chosen_(kRepeats * probes) {
  SUNFLECK_EXPECTS(probes >= 2);
  RandomStream random(seed, 0, RandomPurpose::kProbeResampling);
  for (std::uint32_t& i : chosen_) i = random.below(static_cast<std::uint32_t>(probes));
}

Interval Resamples::interval(const std::function<Figure(std::span<const std::uint32_t>)>& figure) const {
  std::vector<std::uint32_t> all(probes_);
  std::iota(all.begin(), all.end(), 0u);
  const Figure original = figure(all);
  std::vector<double> t(kRepeats, 0.0);
  for (std::size_t r = 0; r < kRepeats; ++r) {
    const Figure repeated = figure(choice(r));
    if (repeated.standard_error > 0.0) t[r] = (repeated.value - original.value) / repeated.standard_error;
  }
  std::sort(t.begin(), t.end());
  // 2 % on each side: drawn from two hundred skewed values, tails of 2.5 % were found to miss six times in a
  // hundred rather than five; of a few dozen (groups) again more.
  constexpr std::size_t kFew = 40;
  const std::size_t tail = probes_ < kFew ? (kRepeats + 1) / 80 : (kRepeats + 1) / 50;
  return {original.value, original.value - t[kRepeats - tail] * original.standard_error,
          original.value - t[tail - 1] * original.standard_error};
}

}  // namespace sunfleck
