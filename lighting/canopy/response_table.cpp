// See response_table.h.
#include "lighting/canopy/response_table.h"

#include <algorithm>
#include <cmath>

#include "sim/base/contract.h"
#include "sim/base/error.h"
#include "sim/base/parallel.h"

namespace sunfleck {

namespace {

constexpr std::size_t kBlock = 1024;  // targets summed together: stay in the first cache

struct BlockSums {
  std::vector<double> value = std::vector<double>(kBlock), variance = std::vector<double>(kBlock);
};

// One direction's part. A share has the variance p (1 - p) per ray.
void add_direction(const float* response, std::size_t count, double strength, double quantum, bool is_share,
                   BlockSums& sums) {
  const double square = strength * strength * quantum;
  for (std::size_t t = 0; t < count; ++t) {
    const double r = response[t];
    sums.value[t] += strength * r;
    sums.variance[t] += square * (is_share ? std::max(0.0, r * (1.0 - r)) : r);
  }
}

}  // namespace

IntervalTable weighted_sum(const ResponseTable& table, const WeightRows& strength,
                           std::span<const double> factor, const RunControl& control) {
  SUNFLECK_EXPECTS(factor.empty() || factor.size() == table.directions);
  if (strength.rows() * table.targets > 2'000'000'000)
    throw Error(ErrorKind::kLimitExceeded, "stand light",
                std::to_string(strength.rows()) + " intervals of " + std::to_string(table.targets) +
                    " targets are too many values",
                "fewer intervals, or a coarser ground map");
  IntervalTable out(strength.rows(), table.targets);
  const std::size_t blocks = (table.targets + kBlock - 1) / kBlock;
  for_each_chunk(strength.rows() * blocks, 16, control, {}, [&](std::size_t begin, std::size_t end) {
    BlockSums sums;
    for (std::size_t job = begin; job < end; ++job) {
      const std::size_t row = job / blocks, first = job % blocks * kBlock;
      const std::size_t count = std::min(kBlock, table.targets - first);
      std::fill_n(sums.value.begin(), count, 0.0);
      std::fill_n(sums.variance.begin(), count, 0.0);
      for (std::size_t i = strength.row_begin[row]; i < strength.row_begin[row + 1]; ++i) {
        const std::size_t d = strength.column[i];
        const double w = strength.value[i] * (factor.empty() ? 1.0 : factor[d]);
        if (w == 0.0) continue;
        add_direction(table.row(d).data() + first, count, w, table.quantum[d],
                      table.kind == ResponseTable::Kind::kShare, sums);
      }
      const std::size_t to = row * table.targets + first;
      for (std::size_t t = 0; t < count; ++t) {
        out.value[to + t] = static_cast<float>(sums.value[t]);
        out.standard_error[to + t] = static_cast<float>(std::sqrt(sums.variance[t]));
      }
    }
  });
  return out;
}

IntervalTable sum_of(const IntervalTable& a, const IntervalTable& b) {
  SUNFLECK_EXPECTS(a.intervals == b.intervals && a.targets == b.targets);
  IntervalTable sum = a;
  for (std::size_t i = 0; i < sum.value.size(); ++i) {
    sum.value[i] += b.value[i];
    sum.standard_error[i] = std::hypot(sum.standard_error[i], b.standard_error[i]);
  }
  return sum;
}

}  // namespace sunfleck
