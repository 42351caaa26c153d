// Several sums at once over a parallel loop, added chunk by chunk in order: the same for any thread count.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/base/parallel.h"

namespace sunfleck::trace {

// Calls body(begin, end, sums) for chunks of [0, count); each chunk adds to its own zeroed sums.
template <std::size_t terms, class Body>
std::array<double, terms> ordered_sums(std::size_t count, std::size_t chunk, const RunControl& control,
                                       Body&& body) {
  std::vector<std::array<double, terms>> partial((count + chunk - 1) / chunk);
  for_each_chunk(count, chunk, control, {}, [&](std::size_t begin, std::size_t end) {
    std::array<double, terms> sums{};
    body(begin, end, sums);
    partial[begin / chunk] = sums;
  });
  std::array<double, terms> total{};
  for (const auto& sums : partial)
    for (std::size_t i = 0; i < terms; ++i) total[i] += sums[i];
  return total;
}

}  // namespace sunfleck::trace
